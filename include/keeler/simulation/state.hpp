// The complete state of a run at the boundary between two steps: exactly the contents of a checkpoint.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/contact_solver/resting_state.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace keeler::diagnostics {
struct ParticleMeans;
} // namespace keeler::diagnostics

namespace keeler::simulation {

/// Energies at the beginning of a run, kg m² rad⁻².
struct EnergyStart {
  double epicyclic = 0.0; ///< Σ m (½κ²e² + ½ν²i²)
  double azimuthal = 0.0; ///< Σ m c_y²
  double spin = 0.0;      ///< Σ ½ I (ω − Ω)² of rough particles
};

/// Balance of the energy of random motions since the run began, with c the velocity relative to the shear flow:
///   energy − start = S (translational_flux + collisional_flux) + kick_work + resting_work − lost.
/// The shear works through the three stresses. Gravity's part enters by the kicks, with the potential energy of the
/// patch as its reservoir (gravity/solver.hpp). No term depends on the origin or on which image of a particle is inside
/// the cell. Energies in kg m² rad⁻², fluxes in kg m² rad⁻¹.
struct EnergyBalance {
  double energy = 0.0; ///< now: Σ m (½c² + ½ν²z²), and the spins' Σ ½ I (ω − Ω)² of rough particles
  double start = 0.0;  ///< this energy at the beginning of the run
  double translational_flux = 0.0; ///< ∫ Σ m c_x c_y dt
  double collisional_flux = 0.0;   ///< Σ over collisions and contacts at rest (x_j − x_i)(p_y gained by j)
  double kick_work = 0.0; ///< Σ m (c·Δv + ½Δv²) over the kicks of all forces, and gravity's at contacts between them
  double resting_work = 0.0; ///< by the impulses of contacts at rest, on the motion along the line of centres
  double lost = 0.0;         ///< in collisions
  double residual = 0.0; ///< change of Σ m (½κ²e² + ½ν²i²) and of the spins' energy, less all accounts: rounding
};

/// The path of a moonlet, from which its drift follows. X and Y minus the shift belong to the body itself, never
/// wrapped.
struct MoonletTrack {
  double start_x = 0.0; ///< X when the run began, m
  double shift_x = 0.0; ///< of X by all wraps, m
  double shift_y = 0.0; ///< of Y by all wraps, m
};

/// The part of the state that belongs to one force.
struct ForceState {
  std::string name;                ///< its table in scenes; "gravity" for self-gravity
  std::vector<Vec3> accelerations; ///< of its last kick, m rad⁻², in the order of the particles
  double work = 0.0; ///< on the motion beyond the shear, by kicks and at contacts between them, kg m² rad⁻²
  double azimuthal_gain = 0.0;       ///< change of Σ m c_y² by its kicks, kg m² rad⁻²
  std::vector<double> moonlet_gains; ///< momentum along the orbit that they gave each moonlet, kg m rad⁻¹
};

/// The automatic step (step_control.hpp). Lengths in ticks, powers of two. A step never crosses a multiple of its
/// length, nor of the kick interval.
struct StepControl {
  std::int64_t step = 1;  ///< length of the next step
  std::int64_t kick = 0;  ///< interval of all forces; 0: set by the scene for each force
  std::int64_t steps = 0; ///< done since the run began

  // tally at the last decision
  std::int64_t decided_at = 0;  ///< tick
  std::uint64_t contacts = 0;   ///< since the run began, up to that tick
  std::uint64_t unresolved = 0; ///< of these

  /// True if a step may begin at that tick.
  bool fits(std::int64_t tick) const { return tick % step == 0 && (kick == 0 || kick % step == 0); }

  /// Returns the first lengths of an automatic step.
  static StepControl automatic(bool with_forces);

  void list_fields(FieldTable& table); ///< adds each of them
};

/// All that a run continues from. Elements refer to the middle of the next step, h/2 after the current tick.
struct SimulationState {
  Particles particles;                  ///< of this rank
  std::vector<ForceState> forces;       ///< self-gravity first, then the external forces of the scene
  ShearingBox box;                      ///< its size and shear
  std::int64_t step = 0;                ///< ticks done; equal to steps unless these are automatic
  double step_length = 0.0;             ///< h of the next step, rad
  StepControl control;                  ///< lengths of the step and of the kick interval
  CollisionTally collisions;            ///< since the run began
  contact_solver::RestingState resting; ///< contacts at rest
  EnergyStart energy;                   ///< when the run began
  std::vector<MoonletTrack> moonlets;   ///< the moonlets have the last ids, in this order
  bool carries = false;                 ///< true if contacts at rest may carry kicks in this scene

  SimulationState() = default;
  /// Makes an empty state with an entry for each force of the scene, ready to be read from a checkpoint.
  explicit SimulationState(const Scene& scene);

  /// Returns every field that an exact restart needs. A new piece of state needs one more line here.
  FieldTable fields();
  /// As above, for writing only: nothing may be read into it.
  FieldTable fields() const;

  /// Returns a description of the first value that no run of this scene can have, or an empty string. Checks what was
  /// read from a file: with such a value a step could read beyond arrays or never end. Does not check the particles
  /// themselves. Collective: each rank has a part of the particles, or none.
  std::string fault(const Scene& scene, const Communicator& ranks = {}) const;

  /// Returns the shear offset at the epoch of the elements, m.
  double epoch_offset() const { return box.offset(2 * step + control.step, 0.5 * tick()); }
  /// Returns the shear offset at this boundary between steps, m.
  double boundary_offset() const { return box.offset(2 * step, 0.5 * tick()); }

  /// Returns the length of a tick, rad.
  double tick() const { return step_length / static_cast<double>(control.step); }

  /// Returns the energy gained from the kicks of all forces, kg m² rad⁻².
  double kick_work() const;

  /// Returns the balance since the run began. Precondition: `means` are of the particles at this boundary.
  EnergyBalance balance(const diagnostics::ParticleMeans& means, const Frequencies& frequencies) const;
};

} // namespace keeler::simulation
