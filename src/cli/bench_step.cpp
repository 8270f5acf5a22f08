// keeler bench step: times whole steps with self-gravity and collisions.
#include "bench.hpp"
#include "bench_numbers.hpp"
#include "print_record.hpp"

#include <keeler/bench/step.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace keeler::cli {
namespace {

struct StepOptions {
  bench::StepBenchSettings bench;
  bool json = false;
  BenchThreadOption threads;
};

ExitCode bench(StepOptions& options) {
  options.threads.apply();
  const bench::StepBench result = measured(options.bench, bench::bench_step, options.bench.ranks);
  print_record(record_of(TimedStep{options.bench, result}), options.json);
  return ExitCode::done;
}

} // namespace

void add_bench_step(CLI::App& bench_command, Action& action, const Communicator& ranks) {
  const auto options = std::make_shared<StepOptions>();
  options->bench.ranks = ranks;
  CLI::App& step = *bench_command.add_subcommand(
      "step", "a whole step, gravity and collisions, in a patch of Saturn's A ring or in a snapshot");
  bench::StepBenchSettings& s = options->bench;
  add_patch_or_snapshot(step, s, "time the state of this snapshot, with the scene in it");
  step.add_option("--kick-every", s.kick_every,
                  "steps per kick of gravity (default: 1; with --from as in the snapshot's scene)")
      ->transform(whole_number_between(1, scene::find_key("gravity.kick_every")->range.high, "a number of steps"));
  one_of(step.add_option("--solver", s.solver,
                         "gravity solver with its default settings (default: tree; with --from that of the snapshot's "
                         "scene)"),
         bench::gravity_solver_names());
  add_repeats(step, s.repeats);
  options->threads.add_to(step);
  step.add_flag("--json", options->json, "print the numbers as JSON");
  examples_of(step, {"keeler bench step --state clumped --count 10000"});
  step.callback([options, &action] { action = [options] { return bench(*options); }; });
}

} // namespace keeler::cli
