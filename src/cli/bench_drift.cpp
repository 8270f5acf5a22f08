// keeler bench drift: the drift phase.
#include "bench.hpp"
#include "bench_counts.hpp"
#include "print.hpp"

#include <keeler/bench/drift.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/words.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <memory>

namespace keeler {
namespace {

const std::map<std::string, BenchSizes> sizes_by_name = {
    {"equal", BenchSizes::equal}, {"power", BenchSizes::power}, {"moonlet", BenchSizes::moonlet}};

struct DriftOptions {
  DriftBenchSettings drift;
  std::string sizes = "equal";
  bool json = false;
  BenchThreadOption threads;
};

double cost_per_orbit_us(const DriftBenchSettings& s, const DriftBench& b) {
  return 1e-3 * b.timed.ns_per_particle_step / s.step_orbits;
}

double collisions_per_orbit(const DriftBenchSettings& s, const DriftBench& b) {
  return 2.0 * b.timed.per_particle_step(b.timed.collisions) / s.step_orbits;
}

void print_json(const DriftBenchSettings& s, const std::string& sizes, const DriftBench& b) {
  const TimedSteps& t = b.timed;
  nlohmann::ordered_json json;
  json["ns_per_particle_step"] = t.ns_per_particle_step;
  json["split"] = {{"advance", t.split.advance},
                   {"build", t.drift_split.build},
                   {"reject", t.drift_split.reject},
                   {"solve", t.drift_split.solve},
                   {"events", t.drift_split.events}};
  json["cost_per_orbit_us"] = cost_per_orbit_us(s, b);
  json["ns_per_collision"] = t.per_contact(t.ns_per_particle_step);
  json["ns_events_per_collision"] = t.per_contact(t.drift_split.events);
  json["ns_per_call"] = b.ns_per_call;
  json["calls_per_particle_step"] = b.calls_per_particle_step;
  json["collisions_per_particle_orbit"] = collisions_per_orbit(s, b);
  add_drift_counts(json, t);
  if (threads() > 1)
    json["speedup"] = {{"step", t.speedup.step}, {"events", t.speedup.events}, {"pair", t.speedup.pair}};
  json["dispersion_r_omega"] = b.dispersion_r_omega;
  json["count"] = t.count;
  json["step_orbits"] = s.step_orbits;
  json["optical_depth"] = s.optical_depth;
  json["sizes"] = sizes;
  json["finder"] = s.finder;
  json["all_pairs"] = s.all_pairs;
  json["threads"] = threads();
  json["repeats"] = s.repeats;
  json["steps"] = t.steps;
  print("{}\n", json_text(json, 2));
}

void print_text(const DriftBenchSettings& s, const DriftBench& b) {
  const TimedSteps& t = b.timed;
  print("ns per particle and step            {:.1f} (median of {} of {}, {}, {})\n", t.ns_per_particle_step,
        counted(s.repeats, "repeat"), counted(t.steps, "step"), counted(t.count, "particle"),
        counted(threads(), "thread"));
  print("  of these                          advance {:.1f}, build {:.1f}, reject {:.1f}, solve {:.1f}, "
        "events {:.1f}\n",
        t.split.advance, t.drift_split.build, t.drift_split.reject, t.drift_split.solve, t.drift_split.events);
  print_over_yardsticks(t.ns_per_particle_step, t.yardsticks);
  if (threads() > 1)
    print("over one thread, by turns           {:.2f} times as fast, the events {:.2f}, a pair {:.2f}\n",
          t.speedup.step, t.speedup.events, t.speedup.pair);
  print("us per particle and orbit           {}\n", figures(cost_per_orbit_us(s, b), 3));
  if (t.contacts > 0)
    print("ns per collision                    {:.0f} for all of that time, {:.0f} for the events alone\n",
          t.per_contact(t.ns_per_particle_step), t.per_contact(t.drift_split.events));
  if (b.calls_per_particle_step > 0.0)
    print("ns per finder call                  {:.1f}, {} calls per particle at the start of a step\n", b.ns_per_call,
          figures(b.calls_per_particle_step, 3));
  else
    print("ns per finder call                  none: no pair came to the finder\n");
  print_pairs(t);
  print("collisions per particle and orbit   {} faster than v_cut\n", figures(collisions_per_orbit(s, b), 3));
  print("bytes per particle                  {}\n", t.bytes_per_particle);
  print("dispersion c_x                      {} r Omega\n", figures(b.dispersion_r_omega, 3));
}

ExitCode bench(const DriftOptions& options) {
  options.threads.apply();
  DriftBenchSettings settings = options.drift;
  settings.sizes = sizes_by_name.at(options.sizes);
  const DriftBench b = measured(settings, bench_drift);
  if (options.json)
    print_json(settings, options.sizes, b);
  else
    print_text(settings, b);
  return ExitCode::done;
}

} // namespace

void add_bench_drift(CLI::App& bench_command, Action& action) {
  const auto options = std::make_shared<DriftOptions>();
  CLI::App& drift = *bench_command.add_subcommand(
      "drift", "the drift phase: spheres in collisional equilibrium, restitution 0.5, no gravity");
  DriftBenchSettings& s = options->drift;
  drift.add_option("--count", s.count, "particles (default: 10000)")->transform(particle_number());
  drift.add_option("--step", s.step_orbits, "step in orbits (default: 0.001)")
      ->check(positive_number(find_key("time.step")->range.high));
  drift.add_option("--optical-depth", s.optical_depth, "optical depth, up to 10 (default: 0.5)")
      ->check(number_between(1e-6, 10.0, "an optical depth"));
  one_of(drift.add_option("--sizes", options->sizes,
                          "equal: all of 1 m; power: n(r) ~ r^-3 from 1 m to 100 m; moonlet: 1 m, and one of 100 m "
                          "(default: equal)"),
         {"equal", "power", "moonlet"});
  one_of(drift.add_option("--finder", s.finder, "collision finder, as in a scene (default: certified)"),
         find_key("collisions.finder")->choices);
  add_repeats(drift, s.repeats);
  drift.add_flag("--all-pairs", s.all_pairs,
                 "hand every candidate of the grid to the finder, without rejecting any first");
  options->threads.add_to(drift);
  drift.add_flag("--json", options->json, "print the numbers as JSON");
  examples_of(drift, {"keeler bench drift --count 10000"});
  drift.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler
