// A clumped state: the initial state of a scene, evolved under its own gravity until its wakes have settled.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/states/settling.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// How a clumped state came about.
struct Clumping {
  SettleCriterion criterion;
  double sample_every_orbits = 0.0; ///< 1 / samples_per_orbit, rounded to whole kick intervals
  double orbits = 0.0;              ///< evolved
  Settling settling;                ///< at the end
  std::vector<WakeSample> history;
};

struct ClumpedState {
  Patch patch; ///< its time is the orbits evolved
  Clumping clumping;
};

/// Where the clumping stands, after each step.
struct ClumpingProgress {
  double orbits = 0.0;
  double elapsed_s = 0.0;           ///< wall time
  double amplitude = 0.0;           ///< of the last sample
  std::optional<Settling> settling; ///< none in the first two windows
  SettleCriterion criterion;
  bool settled = false;
};

/// Evolves the scene's initial state, by the scene's step and gravity, until its wakes have settled; the scene's end
/// time and schedules do not matter. Same scene, same state, for any number of threads. Throws UsageError for a scene
/// without gravity or whose wakes could not be seen, Error (run_time) when they do not settle, Interrupted
/// (interrupt.hpp), and what initial_patch() and Simulation throw.
ClumpedState clumped_state(const Scene& scene, const std::function<void(const ClumpingProgress&)>& progress = {});

/// The record as numbers by name, for SnapshotMeta::clumping.
std::map<std::string, std::vector<double>> clumping_numbers(const Clumping& clumping);

} // namespace keeler
