// keeler bench: what the program's kernels cost on this machine.
#include "command.hpp"
#include "common_options.hpp"

#include <keeler/collision/finders.hpp>
#include <keeler/study/drift_bench.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace keeler {
namespace {

struct BenchOptions {
  DriftBenchSettings drift;
  bool json = false;
  ThreadOption threads;
};

CLI::Validator finder_name() {
  const auto refusal = [](const std::string& name) {
    return make_finder(name) ? std::string() : "there is no finder '" + name + "' (docs/manual/scene.md lists them)";
  };
  return CLI::Validator(refusal, "");
}

void print_json(const DriftBenchSettings& s, const DriftBench& b) {
  nlohmann::ordered_json json;
  json["ns_per_particle_step"] = b.ns_per_particle_step;
  json["ns_per_call"] = b.ns_per_call;
  json["calls_per_particle_step"] = b.calls_per_particle_step;
  json["collisions_per_particle_orbit"] = b.collisions_per_particle_orbit;
  json["dispersion_r_omega"] = b.dispersion_r_omega;
  json["count"] = s.count;
  json["step_orbits"] = s.step_orbits;
  json["optical_depth"] = s.optical_depth;
  json["finder"] = s.finder;
  json["all_pairs"] = s.all_pairs;
  json["threads"] = threads();
  json["repeats"] = s.repeats;
  json["steps"] = b.steps;
  fmt::print("{}\n", json.dump(2));
}

ExitCode bench(const BenchOptions& options) {
  if (options.threads.count == 0)
    set_threads(1);
  options.threads.apply();
  const DriftBench b = bench_drift(options.drift);
  if (options.json) {
    print_json(options.drift, b);
    return ExitCode::done;
  }
  fmt::print("ns per particle and step            {:.1f} (median of {} times {} steps, {} thread{})\n",
             b.ns_per_particle_step, options.drift.repeats, b.steps, threads(), threads() == 1 ? "" : "s");
  if (b.calls_per_particle_step > 0.0)
    fmt::print("ns per finder call                  {:.1f}, {:.3g} calls per particle at the start of a step\n",
               b.ns_per_call, b.calls_per_particle_step);
  else
    fmt::print("ns per finder call                  none: no pair came to the finder\n");
  fmt::print("collisions per particle and orbit   {:.3g} faster than v_cut\n", b.collisions_per_particle_orbit);
  fmt::print("dispersion c_x                      {:.3g} r Omega\n", b.dispersion_r_omega);
  return ExitCode::done;
}

} // namespace

void add_bench(CLI::App& program, Action& action) {
  const auto options = std::make_shared<BenchOptions>();
  CLI::App& command = *program.add_subcommand("bench", "time a kernel on this machine");
  command.require_subcommand(1);
  CLI::App& drift = *command.add_subcommand(
      "drift", "the drift phase: equal spheres in collisional equilibrium, restitution 0.5, no gravity");
  DriftBenchSettings& s = options->drift;
  drift.add_option("--count", s.count, "particles (default: 10000)")->check(positive_number());
  drift.add_option("--step", s.step_orbits, "step in orbits (default: 0.001)")->check(positive_number());
  drift.add_option("--optical-depth", s.optical_depth, "optical depth, up to 10 (default: 0.5)")
      ->check(CLI::Range(1e-6, 10.0).description(""));
  drift.add_option("--finder", s.finder, "collision finder, a name of the manual's scene keys (default: certified)")
      ->check(finder_name());
  drift.add_option("--repeats", s.repeats, "times measured; medians are given (default: 5)")->check(positive_number());
  drift.add_flag("--all-pairs", s.all_pairs,
                 "hand every candidate of the grid to the finder, without rejecting any first");
  drift
      .add_option("--threads", options->threads.count,
                  "threads to use (default: 1); with one, processor time is measured, with more, wall time")
      ->check(positive_number());
  drift.add_flag("--json", options->json, "print the numbers as JSON");
  drift.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler
