// keeler bench step: a whole step with self-gravity and collisions.
#include "bench.hpp"
#include "bench_counts.hpp"
#include "print.hpp"

#include <keeler/bench/step.hpp>
#include <keeler/core/json_of_files.hpp>
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
  const TimedSteps& t = b.timed;
  nlohmann::ordered_json json;
  json["ns_per_particle_step"] = t.ns_per_particle_step;
  json["split"] = {
      {"drift", t.split.drift}, {"advance", t.split.advance}, {"gravity", t.split.gravity}, {"kick", t.split.kick}};
  json["drift_split"] = {{"build", t.drift_split.build},
                         {"reject", t.drift_split.reject},
                         {"solve", t.drift_split.solve},
                         {"events", t.drift_split.events}};
  json["ns_drift_per_collision"] = t.per_contact(t.split.drift);
  json["ns_events_per_collision"] = t.per_contact(t.drift_split.events);
  json["collisions_per_particle_step"] = 2.0 * t.per_particle_step(t.collisions);
  json["contacts_per_particle_step"] = 2.0 * t.per_particle_step(t.contacts);
  add_drift_counts(json, t);
  if (t.ranks > 1) {
    json["ranks"] = t.ranks;
    json["exchange"] = {{"ns", t.exchange.ns},
                        {"messages", t.exchange.messages},
                        {"bytes", t.exchange.bytes},
                        {"common", t.exchange.common}};
    json["shared_again"] = t.shared_again;
  }
  if (t.ranks > 1 || threads() > 1)
    json["speedup"] = {{"step", t.speedup.step},
                       {"drift", t.speedup.drift},
                       {"events", t.speedup.events},
                       {"gravity", t.speedup.gravity},
                       {"pair", t.speedup.pair}};
  json["dispersion_r_omega"] = b.dispersion_r_omega;
  json["solver"] = b.choice.solver;
  json["settings"] = b.choice.text;
  json["kick_every"] = b.choice.settings.kick_every;
  if (options.bench.from)
    json["from"] = *options.bench.from;
  json["count"] = t.count;
  json["step_orbits"] = b.step_orbits;
  json["threads"] = threads();
  json["repeats"] = options.bench.repeats;
  json["steps"] = t.steps;
  print("{}\n", json_text(json, 2));
}

void print_ranks(const TimedSteps& t) {
  print("over one rank, by turns             {:.2f} times as fast, the drift {:.2f}, its events {:.2f}, the "
        "solves {:.2f}\n",
        t.speedup.step, t.speedup.drift, t.speedup.events, t.speedup.gravity);
  print("exchange of {} ranks{:16}{:.1f}, {:.1f} % of a step, waiting included\n", t.ranks, "", t.exchange.ns,
        100.0 * t.exchange.ns / t.ns_per_particle_step);
  print("  a rank sends in a step            {} bytes in {} messages, and takes part in {} common sums\n",
        figures(t.exchange.bytes, 3), figures(t.exchange.messages, 3), figures(t.exchange.common, 3));
  print("  steps done again                  {} of {}\n", t.shared_again, t.steps * t.repeats);
}

void print_text(const StepOptions& options, const StepBench& b) {
  const TimedSteps& t = b.timed;
  print("ns per particle and step            {:.1f} (median of {} of {} of {} orbit, {}, {})\n", t.ns_per_particle_step,
        counted(options.bench.repeats, "repeat"), counted(t.steps, "step"), figures(b.step_orbits),
        counted(t.count, "particle"), counted(threads(), "thread"));
  print("  of these                          drift {:.1f}, advance {:.1f}, gravity {:.1f}, kick {:.1f}\n",
        t.split.drift, t.split.advance, t.split.gravity, t.split.kick);
  print("the drift of these                  build {:.1f}, reject {:.1f}, solve {:.1f}, events {:.1f}\n",
        t.drift_split.build, t.drift_split.reject, t.drift_split.solve, t.drift_split.events);
  print_over_yardsticks(t.split.drift, t.yardsticks);
  if (t.ranks > 1)
    print_ranks(t);
  else if (threads() > 1)
    print("over one thread, by turns           {:.2f} times as fast, the drift {:.2f}, its events {:.2f}, the "
          "solves {:.2f}, a pair {:.2f}\n",
          t.speedup.step, t.speedup.drift, t.speedup.events, t.speedup.gravity, t.speedup.pair);
  print("gravity                             {}, {}, a kick every {}\n", b.choice.solver, b.choice.text,
        counted(b.choice.settings.kick_every, "step"));
  if (t.contacts > 0)
    print("ns per collision                    {:.0f} for the drift, {:.0f} for the events alone\n",
          t.per_contact(t.split.drift), t.per_contact(t.drift_split.events));
  print_pairs(t);
  print("contacts per particle and step      {}\n", figures(2.0 * t.per_particle_step(t.contacts), 3));
  print("collisions per particle and step    {} faster than v_cut\n",
        figures(2.0 * t.per_particle_step(t.collisions), 3));
  print("bytes per particle                  {} held by the drift\n", t.bytes_per_particle);
  print("dispersion c_x                      {} r Omega\n", figures(b.dispersion_r_omega, 3));
}

ExitCode bench(StepOptions& options) {
  options.threads.apply();
  const StepBench result = measured(options.bench, bench_step, options.bench.ranks);
  if (options.json)
    print_json(options, result);
  else
    print_text(options, result);
  return ExitCode::done;
}

} // namespace

void add_bench_step(CLI::App& bench_command, Action& action, const Ranks& ranks) {
  const auto options = std::make_shared<StepOptions>();
  options->bench.ranks = ranks;
  CLI::App& step = *bench_command.add_subcommand(
      "step", "a whole step, gravity and collisions, in a clumped patch of Saturn's A ring or in a snapshot");
  StepBenchSettings& s = options->bench;
  CLI::Option* count = step.add_option("--count", s.count, "particles of the clumped patch (default: 100000)")
                           ->transform(particle_number());
  step.add_option("--from", s.from, "time the state of this snapshot as it stands, with the scene that it holds")
      ->type_name("FILE")
      ->excludes(count);
  step.add_option("--kick-every", s.kick_every,
                  "steps for each kick of gravity (default: 1; with --from as in the snapshot's scene)")
      ->transform(whole_number_between(1, find_key("gravity.kick_every")->range.high, "a number of steps"));
  one_of(step.add_option("--solver", s.solver,
                         "gravity solver with its default settings (default: tree; with --from that of the snapshot's "
                         "scene)"),
         gravity_solver_names());
  add_repeats(step, s.repeats);
  options->threads.add_to(step);
  step.add_flag("--json", options->json, "print the numbers as JSON");
  examples_of(step, {"keeler bench step --count 10000"});
  step.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler
