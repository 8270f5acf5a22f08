// A clumped state: the initial state of a scene, evolved under its own gravity until its wakes have settled.
#pragma once

#include <keeler/initial_conditions/settling.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

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
  std::vector<SettleSample> history;
  double orbital_frequency = 0.0; ///< rad/s: makes m²/s of m² rad⁻¹
};

struct ClumpedState {
  Patch patch; ///< its time is the orbits evolved
  Clumping clumping;
};

/// Where the clumping stands, after each step.
struct ClumpingProgress {
  double orbits = 0.0;
  double elapsed_s = 0.0;           ///< wall time
  double contrast = 0.0;            ///< of the last sample: rms of the smoothed Σ/⟨Σ⟩ − 1
  std::optional<Settling> settling; ///< none before criterion.least_orbits()
  SettleCriterion criterion;
  bool settled = false;
};

/// Evolves the scene's initial state, by the scene's step and gravity, until its wakes have settled; the scene's end
/// time and schedules do not matter. Same scene and criterion, same state, for any number of threads. Throws UsageError
/// for a scene without gravity or whose wakes could not be seen, and for a limit of orbits below which nothing settles;
/// Error (run_time) when they have not settled by then; BrokenState (broken.hpp) when a step comes to what cannot be;
/// Interrupted (interrupt.hpp), and what initial_patch() and Simulation throw.
ClumpedState clumped_state(const Scene& scene, const SettleCriterion& criterion = {},
                           const std::function<void(const ClumpingProgress&)>& progress = {});

/// The record as numbers by name, for SnapshotMeta::clumping.
std::map<std::string, std::vector<double>> clumping_numbers(const Clumping& clumping);

} // namespace keeler
