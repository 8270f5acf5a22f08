// keeler bench light: times the ray tracer.
#include "bench.hpp"
#include "bench_numbers.hpp"
#include "print_record.hpp"

#include <keeler/bench/light.hpp>
#include <keeler/core/threads.hpp>

#include <memory>

namespace keeler::cli {
namespace {

struct TimedLight {
  const bench::LightBenchSettings& settings;
  const bench::LightBench& bench;
};

struct LightOptions {
  bench::LightBenchSettings bench;
  bool json = false;
  BenchThreadOption threads;
};

std::vector<quantities::QuantityRow<TimedLight>> light_rows() {
  using quantities::Value;
  using Light = const TimedLight&;
  const auto three = [](const char* name, const quantities::Unit& unit, const char* label, const char* meaning) {
    return quantities::Quantity{name, unit, label, meaning, quantities::Spread::none, quantities::Forms::si, 3};
  };
  constexpr quantities::Unit rate = quantities::unit::unnamed("/s");
  return {
      {three("paths_per_s", rate, "paths", "rays with all their orders of scattering, per second and thread"),
       [](Light l) -> Value { return l.bench.paths_per_s; }},
      {three("first_hits_per_s", rate, "first sphere",
             "rays with the first sphere that they meet, per second and thread"),
       [](Light l) -> Value { return l.bench.first_hits_per_s; }},
      {three("any_hits_per_s", rate, "any sphere", "rays of which only is asked whether they meet a sphere"),
       [](Light l) -> Value { return l.bench.any_hits_per_s; }},
      {three("embree_rays_per_s", rate, "Embree alone, single rays",
             "Embree's query for any sphere, of rays that begin side by side and end at the faces of the cell"),
       [](Light l) -> Value { return l.bench.embree_rays_per_s; }},
      {three("embree_packet_rays_per_s", rate, "Embree alone, packets of 16", "the same rays in packets"),
       [](Light l) -> Value { return l.bench.embree_packet_rays_per_s; }},
      {three("spheres_met", quantities::unit::none, "spheres on a path", "mean number of spheres that a path meets"),
       [](Light l) -> Value { return l.bench.spheres_met; }},
      {three("one_percent", quantities::unit::seconds, "I/F to 1 %",
             "wall time of an I/F with a standard error of 1 % at this sight, with all threads"),
       [](Light l) -> Value { return l.bench.one_percent_s; }},
      {{"one_percent_rays", quantities::unit::none, "  its rays", "number of rays that it takes"},
       [](Light l) -> Value { return l.bench.one_percent_rays; }},
      {three("scene", quantities::unit::seconds, "Embree's scene", "wall time to build it"),
       [](Light l) -> Value { return l.bench.scene_s; }},
      {{"elevation", quantities::unit::degrees, "elevation", "of observer and Sun; the phase angle is 6 degrees"},
       [](Light l) -> Value { return l.settings.elevation; }},
      {{"count", quantities::unit::none, "particles", "N"},
       [](Light l) -> Value { return std::uint64_t{l.bench.count}; }},
      {quantities::word("state", "state", "that is timed"), [](Light l) -> Value { return l.settings.state; },
       [](Light l) { return !l.settings.from.has_value(); }},
      {quantities::word("from", "from", "the timed snapshot"), [](Light l) -> Value { return *l.settings.from; },
       [](Light l) { return l.settings.from.has_value(); }},
      {three("preparation", quantities::unit::seconds, "preparation", "time to make or read the state"),
       [](Light l) -> Value { return l.bench.preparation_s; }},
      {{"threads", quantities::unit::none, "threads", "that were used"},
       [](Light) -> Value { return static_cast<std::uint64_t>(threads()); }},
      {{"repeats", quantities::unit::none, "repeats", "times measured"},
       [](Light l) -> Value { return static_cast<std::uint64_t>(l.settings.repeats); }},
  };
}

ExitCode bench(const LightOptions& options) {
  options.threads.apply();
  const bench::LightBench found = measured(options.bench, bench::bench_light);
  print_record({entries_of(light_rows(), TimedLight{options.bench, found})}, options.json);
  return ExitCode::done;
}

} // namespace

std::vector<quantities::Quantity> light_bench_quantities() {
  return quantities_of(light_rows());
}

void add_bench_light(CLI::App& bench_command, Action& action) {
  const auto options = std::make_shared<LightOptions>();
  CLI::App& light = *bench_command.add_subcommand(
      "light", "the ray tracer: paths of sunlight and single rays among the spheres of a patch or a snapshot");
  bench::LightBenchSettings& s = options->bench;
  add_patch_or_snapshot(light, s, "trace the spheres of this snapshot");
  light.add_option("--elevation", s.elevation, "of observer and Sun, degrees (default: 20)")
      ->check(number_between(0.1, 90.0, "an elevation"));
  add_repeats(light, s.repeats);
  options->threads.add_to(light);
  light.add_flag("--json", options->json, "print the numbers as JSON");
  examples_of(light, {"keeler bench light --state clumped --count 10000", "keeler bench light --from wakes.hdf"});
  light.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler::cli
