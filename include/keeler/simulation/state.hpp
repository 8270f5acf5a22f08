// The whole state of a run at the boundary between two steps: what a checkpoint holds and nothing less.
#pragma once

#include <keeler/box/shearing_box.hpp>
#include <keeler/collision/drift.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

/// Where the epicyclic energy of a run went, its collisions and forces apart. kg m² rad⁻².
struct EnergyBudget {
  double start = 0.0;     ///< Σ m [½κ²e² + ½ν²i² − (Sκ²/4) X²] when the run began
  double wrap_work = 0.0; ///< gained when guiding centres were wrapped across the sheared edges
};

/// What a force has left in the state.
struct ForceState {
  std::string name;
  std::vector<Vec3> accelerations; ///< of its last kick, m rad⁻², in the order of the particles
  double work = 0.0;               ///< energy gained from its kicks, kg m² rad⁻²
};

/// Elements stand at the middle of the step to come: step · h + h/2.
struct SimulationState {
  Particles particles;
  std::vector<ForceState> forces; ///< self-gravity first, then the external forces of the scene
  ShearingBox box;
  std::int64_t step = 0;    ///< steps done
  double step_length = 0.0; ///< h, rad
  CollisionTally collisions;
  EnergyBudget energy;

  SimulationState() = default;
  /// An empty state with a place for each force of the scene: what a checkpoint is read into.
  explicit SimulationState(const Scene& scene);

  /// Every field that must be stored to continue exactly. A new piece of state is one more line here.
  FieldTable fields();

  /// Shear offset at the epoch of the elements, and at this boundary between steps.
  double epoch_offset() const { return box.offset(2 * step + 1, 0.5 * step_length); }
  double boundary_offset() const { return box.offset(2 * step, 0.5 * step_length); }

  /// Energy gained from the kicks of all forces, kg m² rad⁻².
  double kick_work() const;
};

/// Σ m × epicyclic energy per mass; kg m² rad⁻².
double total_energy(const Particles& particles, const Frequencies& frequencies);

} // namespace keeler
