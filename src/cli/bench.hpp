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
