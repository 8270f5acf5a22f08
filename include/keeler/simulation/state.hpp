// The whole state of a run at the boundary between two steps: what a checkpoint holds and nothing less.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/contact_solver/resting_contacts.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/step_control.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler {

/// What the budget of a run began with, kg m² rad⁻².
struct EnergyStart {
  double epicyclic = 0.0; ///< Σ m (½κ²e² + ½ν²i²)
  double azimuthal = 0.0; ///< Σ m c_y²
  double spin = 0.0;      ///< Σ ½ I (ω − Ω)² of rough particles
};

/// Where the energy of the random motions came from and went since the run began: with c the velocity beyond the shear,
///   energy − start = S (translational_flux + collisional_flux) + kick_work + resting_work − lost.
/// The shear does its work by the three stresses; gravity's part comes in by the kicks, and the potential energy of the
/// patch is its reservoir (gravity/solver.hpp). No term depends on the origin or on which image of a
/// particle is inside the cell. Energies in kg m² rad⁻², fluxes in kg m² rad⁻¹.
struct EnergyBalance {
  double energy = 0.0; ///< now: Σ m (½c² + ½ν²z²), and the spins' Σ ½ I (ω − Ω)² of rough particles
  double start = 0.0;  ///< the same when the run began
  double translational_flux = 0.0; ///< ∫ Σ m c_x c_y dt
  double collisional_flux = 0.0;   ///< Σ over collisions and contacts at rest (x_j − x_i)(p_y gained by j)
  double kick_work = 0.0;          ///< Σ m (c·Δv + ½Δv²) over the kicks of all forces
  double resting_work = 0.0;       ///< of the impulses of contacts at rest, on the motion along the line of centres
  double lost = 0.0;               ///< in collisions
  double residual =
      0.0; ///< what Σ m (½κ²e² + ½ν²i²), and the spins' energy, has changed beyond all that was booked: rounding
};

/// Of a moonlet: from where it has come, to tell its drift and what drove it. X and Y less `shift` are those of the
/// body itself, never wrapped.
struct MoonletTrack {
  double start_x = 0.0;                ///< X when the run began, m
  double shift_x = 0.0, shift_y = 0.0; ///< by wraps so far, m
};

/// What a force has left in the state.
struct ForceState {
  std::string name;
  std::vector<Vec3> accelerations;   ///< of its last kick, m rad⁻², in the order of the particles
  double work = 0.0;                 ///< of its kicks on the motion beyond the shear, kg m² rad⁻²
  double azimuthal_gain = 0.0;       ///< what they added to Σ m c_y², kg m² rad⁻²
  std::vector<double> moonlet_gains; ///< momentum along the orbit that they gave each moonlet, kg m rad⁻¹
};

/// Elements stand at the middle of the step to come, h/2 after the present tick.
struct SimulationState {
  Particles particles;
  std::vector<ForceState> forces; ///< self-gravity first, then the external forces of the scene
  ShearingBox box;
  std::int64_t step = 0;    ///< ticks done: steps, where these are not automatic
  double step_length = 0.0; ///< h of the step to come, rad
  StepControl control;
  CollisionTally collisions;
  RestingState resting;
  EnergyStart energy;
  std::vector<MoonletTrack> moonlets; ///< of the last ids, in their order
  bool carries = false;               ///< whether contacts at rest may carry kicks in this scene

  SimulationState() = default;
  /// An empty state with a place for each force of the scene: what a checkpoint is read into.
  explicit SimulationState(const Scene& scene);

  /// Every field that must be stored to continue exactly. A new piece of state is one more line here.
  FieldTable fields();
  /// The same of a state that is only to be stored: nothing may be read into it.
  FieldTable fields() const;

  /// What in it no run of this scene has: "its step is 0 ticks long"; empty where nothing is. Of what was read from a
  /// file: a step would read beyond arrays, or not end. The particles themselves are for the step to judge. Collective:
  /// each rank has a part of the particles, or none.
  std::string fault(const Scene& scene, const Communicator& ranks = {}) const;

  /// Shear offset at the epoch of the elements, and at this boundary between steps.
  double epoch_offset() const { return box.offset(2 * step + control.step, 0.5 * tick()); }
  double boundary_offset() const { return box.offset(2 * step, 0.5 * tick()); }

  /// Length of a tick, rad.
  double tick() const { return step_length / static_cast<double>(control.step); }

  /// Energy gained from the kicks of all forces, kg m² rad⁻².
  double kick_work() const;

  /// `means` are those of the particles at this boundary.
  EnergyBalance balance(const ParticleMeans& means, const Frequencies& frequencies) const;
};

} // namespace keeler
