// The subcommands of keeler bench, and their common options.
#pragma once

#include "command.hpp"
#include "common_options.hpp"
#include "progress_line.hpp"

#include <keeler/bench/gravity_choices.hpp>

namespace keeler::cli {

void add_bench_drift(CLI::App& bench, Action& action);
void add_bench_gravity(CLI::App& bench, Action& action);
void add_bench_light(CLI::App& bench, Action& action);
void add_bench_step(CLI::App& bench, Action& action, const Communicator& ranks);

/// --threads N of a bench; one thread by default.
struct BenchThreadOption {
  int count = 1;

  void add_to(CLI::App& command) {
    command
        .add_option("--threads", count,
                    "threads to use (default: 1); with one, processor time is measured, with more, wall time")
        ->transform(thread_number());
  }

  void apply() const {
    set_threads(count);
    start_threads();
  }
};

/// Adds --repeats N.
inline void add_repeats(CLI::App& command, int& repeats) {
  command.add_option("--repeats", repeats, "number of measurements; their medians are printed (default: 5)")
      ->transform(repeat_number());
}

/// Adds --state NAME of the benches with self-gravity.
inline CLI::Option& add_state(CLI::App& command, std::string& state) {
  return one_of(command.add_option("--state", state,
                                   "settled: self-gravity wakes past their overshoot, made once in minutes and kept in "
                                   "the user's cache folder; clumped: wakes as they form; uniform: a uniform initial "
                                   "state (default: settled)"),
                bench::gravity_state_names());
}

/// Adds --count, --state and --from: the patch of a bench, or a snapshot in its place. `what_of_file` is its help.
template<class Settings> void add_patch_or_snapshot(CLI::App& command, Settings& settings, const char* what_of_file) {
  CLI::Option* count =
      command
          .add_option("--count", settings.count, "particles of the patch, at least 25336 of settled (default: 100000)")
          ->transform(particle_number());
  CLI::Option& state = add_state(command, settings.state);
  command.add_option("--from", settings.from, what_of_file)->type_name("FILE")->excludes(count)->excludes(&state);
}

/// Returns measure(settings). Rank 0 shows progress after five seconds.
template<class Settings, class Measure>
auto measured(Settings settings, const Measure& measure, const Communicator& ranks = {}) {
  constexpr double quiet_s = 5.0;
  if (!ranks.is_root())
    return measure(settings);
  ProgressLine line;
  settings.progress = [&line](const Progress& progress) {
    if (progress.elapsed_s > quiet_s)
      line.show(progress);
  };
  return measure(settings);
}

} // namespace keeler::cli
