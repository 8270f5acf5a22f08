// A force accelerates particles between drifts. The step applies its accelerations as half kicks before and after each
// kick interval, accounts for their work under the force's name, and keeps the last accelerations in the state of the
// run, so that a restart is bit-identical.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/key.hpp>
#include <keeler/gravity/solver.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::forces {

/// The particles at the boundary between two steps, as a force sees them.
struct Boundary {
  const Particles& particles; ///< elements refer to the epoch
  /// κ/Ω and ν/Ω.
  Frequencies frequencies;
  double to_epoch; ///< time from this boundary to the epoch, rad
  /// Its size and shear.
  ShearingBox box;
  double offset;           ///< the box's shear offset at this boundary, m
  std::int64_t step;       ///< ticks done
  double time = 0.0;       ///< since the run began, rad
  Communicator ranks = {}; ///< each rank has its own particles
  /// From kick to kick of this force, rad: the two half kicks with the accelerations of this boundary last that long,
  /// unless an automatic step changes here.
  double interval = 0.0;

  /// Returns the rotation of elements from the epoch back to this boundary.
  Rotation rotation() const { return {frequencies, -to_epoch}; }
};

/// What accelerates particles between drifts: self-gravity, or an external force.
class Force {
public:
  virtual ~Force() = default;

  /// Returns the number of steps from kick to kick. Runs stop and write at the kicks of self-gravity, so an external
  /// force must kick as often, or at a divisor of that interval. The default is 1.
  virtual std::int64_t kick_every() const { return 1; }

  /// Writes each particle's acceleration (m rad⁻²; one in m s⁻² is divided by Ω²), in the order of the particles.
  /// Collective. The result must depend on the particles, the step and the force's parameters only: not on threads, the
  /// order in memory, the number of ranks or earlier calls. A restart is bit-identical then. A force that depends on
  /// velocities sees those before both half kicks that it makes here: its step is of first order in its own rate times
  /// the step, and of second order if interval times the acceleration is the change of velocity that its own equation
  /// of motion gives in `interval` (docs/theory/gas-drag.md). Precondition: one acceleration per particle.
  virtual void accelerate(const Boundary& boundary, std::span<Vec3> accelerations) = 0;

  /// Returns the energy and the stress of the particles in their own field, or nothing if the force cannot measure
  /// them. Collective; does not affect later steps.
  virtual std::optional<gravity::GravityEnergy> energy(const Boundary&) { return std::nullopt; }
};

/// The data from which a force may be made when a run starts or continues. Valid only while the force is made. A force
/// is also made, and dropped, when a scene is read: then there are no masses.
struct ForceContext {
  std::span<const double> masses; ///< kg, in the order of the particles
  /// Its size and shear.
  ShearingBox box;
  double orbital_frequency = 0.0; ///< rad/s
  /// Seed of all random numbers, particles.seed of the scene.
  std::uint64_t seed = 1;
  Communicator ranks = {}; ///< each rank has its own particles; all ranks make each force together
};

/// A force that a scene selects by a table. What the force does must follow from its keys: they are in the state hash,
/// and what `make` captures is not.
struct ForceEntry {
  const char* table;     ///< its name in scenes, checkpoints, the time split and the energy budget; a literal
  std::vector<Key> keys; ///< at least one, by their names in the table; all affect the motion
  /// Makes the force from the checked values; throws UsageError if they do not fit together.
  std::function<std::unique_ptr<Force>(const Parameters& parameters, const ForceContext& context)> make;
  /// Throws UsageError if the values do not fit a box of this radial size; null: no check. `make` repeats the check,
  /// for boxes that the scene does not define.
  void (*check)(const Parameters& parameters, double size_x) = nullptr;
};

/// Adds a force of the calling program, in any thread. Scenes that are read from then on have its table; a program
/// without it refuses such a scene or checkpoint. Added forces kick after Keeler's, in the order of their names. Throws
/// UsageError for an invalid entry, or a name that is taken.
void add_force(ForceEntry entry, IfTaken if_taken = IfTaken::refuse);

/// Returns all forces but self-gravity, which has settings of a separate type (self_gravity.hpp) because solvers are
/// selected, measured and tuned by them. The list never changes: what is added later is in another one.
const std::vector<ForceEntry>& external_forces();

} // namespace keeler::forces
