// The main loop of a run: steps, and outputs when they are due, until the end or a stop request.
#pragma once

#include "recorder.hpp"
#include "step_check.hpp"

#include <keeler/core/stopwatch.hpp>
#include <keeler/forces/satellite.hpp>
#include <keeler/runs/run.hpp>

#include <optional>

namespace keeler::runs {

/// Returns the end of a run, in orbits.
inline double end_orbits(const Scene& scene) {
  return static_cast<double>(scene.time.end_step) * scene.time.step;
}

class Runner {
public:
  /// All references must outlive the runner. `watch` runs since the command began, like the time limit of a batch
  /// queue; `last_checkpoint` is a step, or -1.
  Runner(const Scene& scene, const RunOptions& options, RunRequests& requests, Simulation& simulation,
         Recorder& recorder, const Stopwatch& watch, std::int64_t last_checkpoint);

  /// Runs to the end or a stop, and returns the result without `resume_command`. Collective. Throws the exceptions of
  /// the steps and outputs.
  RunResult run();

  /// Returns the step of the newest checkpoint; -1: none yet.
  std::int64_t last_checkpoint() const { return last_checkpoint_; }

private:
  const Communicator& ranks() const { return simulation_.ranks(); }
  void advance();
  bool due(std::int64_t every) const { return every > 0 && simulation_.state().step % every == 0; }
  // Stops and snapshots are allowed only at the end of a kick interval: before it the closing half kick is missing.
  bool between_kicks() const { return due(scene_.kick_interval()); }
  double steps_between_stops() const { return static_cast<double>(scene_.kick_interval()); }
  bool must_stop() const;
  void record();
  void observe();
  void report_passage();
  bool checkpoint_due_by_clock() const;
  // For a single particle the pulls of its images cancel, so a relative error is undefined.
  bool has_force_checks() const { return scene_.gravity && scene_.gravity->by_pairs() && simulation_.count() > 1; }
  bool force_check_due() const;
  unsigned stop_timeout() const;
  void update_step_cost(double now);
  void report();

  const Scene& scene_;
  const RunOptions& options_;
  RunRequests& requests_;
  Simulation& simulation_;
  Recorder& recorder_;
  const Stopwatch& watch_; // since the command began
  std::optional<StepCheck> check_;
  std::optional<forces::SatellitePassage> passage_; // the next one that the box cannot represent well
  std::int64_t first_step_, last_checkpoint_;
  std::uint64_t first_collisions_;
  std::int64_t cost_step_ = first_step_;
  double seconds_per_step_ = 0.0, cost_s_ = watch_.elapsed();
  double start_ = watch_.elapsed(), last_time_ = start_, last_checkpoint_time_ = start_, longest_step_s_ = 0.0;
};

} // namespace keeler::runs
