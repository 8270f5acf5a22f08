// keeler bench drift: times the drift phase.
#include "bench.hpp"
#include "bench_numbers.hpp"
#include "print_record.hpp"

#include <keeler/bench/drift.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <memory>

namespace keeler::cli {
namespace {

const std::map<std::string, bench::BenchSizes> sizes_by_name = {
    {"equal", bench::BenchSizes::equal}, {"power", bench::BenchSizes::power}, {"moonlet", bench::BenchSizes::moonlet}};

struct DriftOptions {
  bench::DriftBenchSettings drift;
  std::string sizes = "equal";
  bool json = false;
  BenchThreadOption threads;
};

ExitCode bench(const DriftOptions& options) {
  options.threads.apply();
  bench::DriftBenchSettings settings = options.drift;
  settings.sizes = sizes_by_name.at(options.sizes);
  const bench::DriftBench b = measured(settings, bench::bench_drift);
  print_record(record_of(TimedDrift{settings, options.sizes, b}), options.json);
  return ExitCode::done;
}

} // namespace

void add_bench_drift(CLI::App& bench_command, Action& action) {
  const auto options = std::make_shared<DriftOptions>();
  CLI::App& drift = *bench_command.add_subcommand(
      "drift", "the drift phase: spheres in collisional equilibrium, restitution 0.5, no gravity");
  bench::DriftBenchSettings& s = options->drift;
  drift.add_option("--count", s.count, "particles (default: 10000)")->transform(particle_number());
  drift.add_option("--step", s.step_orbits, "step in orbits (default: 0.001)")
      ->check(positive_number(scene::find_key("time.step")->range.high));
  drift.add_option("--optical-depth", s.optical_depth, "optical depth, up to 10 (default: 0.5)")
      ->check(number_between(1e-6, 10.0, "an optical depth"));
  one_of(drift.add_option("--sizes", options->sizes,
                          "equal: all 1 m; power: n(r) ~ r^-3 from 1 m to 100 m; moonlet: 1 m, with one of 100 m "
                          "(default: equal)"),
         {"equal", "power", "moonlet"});
  one_of(drift.add_option("--finder", s.finder, "collision finder, as in a scene (default: certified)"),
         scene::find_key("collisions.finder")->choices);
  add_repeats(drift, s.repeats);
  drift.add_flag("--all-pairs", s.all_pairs,
                 "pass every candidate pair of the grid to the finder, without prior rejection");
  options->threads.add_to(drift);
  drift.add_flag("--json", options->json, "print the numbers as JSON");
  examples_of(drift, {"keeler bench drift --count 10000"});
  drift.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler::cli
