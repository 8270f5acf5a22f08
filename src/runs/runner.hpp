// A run at work: step by step, with its outputs when they are due, until its end or until it is asked to stop.
#pragma once

#include "recorder.hpp"
#include "step_check.hpp"

#include <keeler/core/stopwatch.hpp>
#include <keeler/forces/satellite.hpp>
#include <keeler/runs/run.hpp>

#include <optional>

namespace keeler {

/// Where a run is to end, orbits.
inline double end_orbits(const Scene& scene) {
  return static_cast<double>(scene.time.end_step) * scene.time.step;
}

class Runner {
public:
  /// All must outlive it. `watch` runs since the command began, as a queue counts; `last_checkpoint` is a step, or -1.
  Runner(const Scene& scene, const RunOptions& options, RunRequests& requests, Simulation& simulation,
         Recorder& recorder, const Stopwatch& watch, std::int64_t last_checkpoint);

  /// Collective. All of the result but the command to go on with. Throws what a step and what its outputs throw.
  RunResult run();

  /// -1: none yet.
  std::int64_t last_checkpoint() const { return last_checkpoint_; }

private:
  const Communicator& ranks() const { return simulation_.ranks(); }
  void advance();
  bool due(std::int64_t every) const { return every > 0 && simulation_.state().step % every == 0; }
  // Half way through a kick interval the closing half kick is missing: stop and snapshot only at its end.
  bool between_kicks() const { return due(scene_.kick_interval()); }
  double passes_between_stops() const { return static_cast<double>(scene_.kick_interval()); }
  bool must_stop() const;
  void record();
  void tell_of_passage();
  bool checkpoint_due_by_clock() const;
  // The exact sum is over pairs, wherever they are. A particle alone has its own images, whose pulls cancel: nothing
  // that an error could be a part of.
  bool has_force_checks() const {
    return scene_.gravity && scene_.gravity->by_pairs() && !ranks().distributed() && simulation_.count() > 1;
  }
  bool force_check_due() const;
  unsigned patience() const;
  void take_pace(double now);
  void report();

  const Scene& scene_;
  const RunOptions& options_;
  RunRequests& requests_;
  Simulation& simulation_;
  Recorder& recorder_;
  const Stopwatch& watch_; // since the command began, as a queue counts
  std::optional<StepCheck> check_;
  std::optional<SatellitePassage> passage_; // the next one that a cell cannot show well
  std::int64_t first_step_, last_checkpoint_;
  std::uint64_t first_collisions_;
  std::int64_t paced_step_ = first_step_;
  double seconds_per_step_ = 0.0, paced_s_ = watch_.elapsed();
  double start_ = watch_.elapsed(), last_time_ = start_, last_checkpoint_time_ = start_, longest_pass_ = 0.0;
};

} // namespace keeler
