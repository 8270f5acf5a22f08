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

/// The record of how a clumped state was made.
struct Clumping {
  SettleCriterion criterion;
  double sample_every_orbits = 0.0; ///< 1 / samples_per_orbit, rounded to whole kick intervals
  double orbits = 0.0;              ///< number of orbits evolved
  Settling settling;                ///< at the end
  std::vector<SettleSample> history;
  double orbital_frequency = 0.0; ///< rad/s: converts m² rad⁻¹ to m²/s
};

struct ClumpedState {
  Patch patch; ///< its time is the orbits evolved
  Clumping clumping;
};

/// Progress of the evolution, reported after each step.
struct ClumpingProgress {
  double orbits = 0.0;
  double elapsed_s = 0.0;           ///< wall time
  double contrast = 0.0;            ///< of the last sample: rms of the smoothed Σ/⟨Σ⟩ − 1
  std::optional<Settling> settling; ///< empty before criterion.min_orbits()
  SettleCriterion criterion;
  bool settled = false;
};

/// Evolves the scene's initial state, with the scene's step and gravity, until its wakes have settled; ignores the
/// scene's end time and schedules. The result depends on scene and criterion only, not on the number of threads. Throws
/// UsageError for a scene without gravity or too small for wakes, and for a limit of orbits that is too short to
/// settle; Error (run_time) if they have not settled by then; BrokenState (broken.hpp) if a step violates an invariant;
/// Interrupted (interrupt.hpp), and what initial_patch() and Simulation throw.
ClumpedState clumped_state(const Scene& scene, const SettleCriterion& criterion = {},
                           const std::function<void(const ClumpingProgress&)>& progress = {});

/// Returns the record as numbers by name, for SnapshotMeta::clumping.
std::map<std::string, std::vector<double>> clumping_numbers(const Clumping& clumping);

} // namespace keeler
