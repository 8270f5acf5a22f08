// keeler bench step: a whole step with self-gravity and collisions.
#include "bench.hpp"

#include <keeler/bench/step.hpp>
#include <keeler/core/words.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace keeler {
namespace {

struct StepOptions {
  StepBenchSettings bench;
  bool json = false;
  BenchThreadOption threads;
};

void print_json(const StepOptions& options, const StepBench& b) {
  nlohmann::ordered_json json;
  json["ns_per_particle_step"] = b.ns_per_particle_step;
  json["split"] = {
      {"drift", b.split.drift}, {"advance", b.split.advance}, {"gravity", b.split.gravity}, {"kick", b.split.kick}};
  json["collisions_per_particle_step"] = b.collisions_per_particle_step;
  json["solver"] = b.choice.solver;
  json["settings"] = b.choice.text;
  json["kick_every"] = options.bench.kick_every;
  json["count"] = b.count;
  json["step_orbits"] = b.step_orbits;
  json["threads"] = threads();
  json["repeats"] = options.bench.repeats;
  json["steps"] = b.steps;
  fmt::print("{}\n", json.dump(2));
}

void print_text(const StepOptions& options, const StepBench& b) {
  fmt::print("ns per particle and step            {:.1f} (median of {} of {} of {} orbit, {}, {})\n",
             b.ns_per_particle_step, counted(options.bench.repeats, "repeat"), counted(b.steps, "step"),
             figures(b.step_orbits), counted(b.count, "particle"), counted(threads(), "thread"));
  fmt::print("  of these                          drift {:.1f}, advance {:.1f}, gravity {:.1f}, kick {:.1f}\n",
             b.split.drift, b.split.advance, b.split.gravity, b.split.kick);
  fmt::print("gravity                             {}, {}, a kick every {}\n", b.choice.solver, b.choice.text,
             counted(options.bench.kick_every, "step"));
  fmt::print("collisions per particle and step    {} faster than v_cut\n", figures(b.collisions_per_particle_step, 3));
}

ExitCode bench(StepOptions& options) {
  options.threads.apply();
  const StepBench result = measured(options.bench, bench_step);
  if (options.json)
    print_json(options, result);
  else
    print_text(options, result);
  return ExitCode::done;
}

} // namespace

void add_bench_step(CLI::App& bench_command, Action& action) {
  const auto options = std::make_shared<StepOptions>();
  CLI::App& step = *bench_command.add_subcommand(
      "step", "a whole step of 1/1000 orbit, gravity and collisions, in a clumped patch of Saturn's A ring");
  StepBenchSettings& s = options->bench;
  step.add_option("--count", s.count, "particles (default: 100000)")->check(positive_number());
  step.add_option("--kick-every", s.kick_every, "steps for each kick of gravity (default: 1)")
      ->check(positive_number());
  step.add_option("--solver", s.solver, "gravity solver (default: tree)")
      ->check(CLI::IsMember(gravity_solver_names()).description(""));
  add_repeats(step, s.repeats);
  options->threads.add_to(step);
  step.add_flag("--json", options->json, "print the numbers as JSON");
  step.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler
