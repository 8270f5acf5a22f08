// A force: what accelerates particles between drifts. The step turns its accelerations into half kicks before and after
// each of its kick intervals, books the work of these kicks under its name, and keeps its last accelerations in the
// state of the run, so that a restart goes on to the bit.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/core/key.hpp>
#include <keeler/gravity/solver.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler {

/// The particles at the boundary between two steps.
struct Boundary {
  const Particles& particles; ///< their elements stand at the epoch
  Frequencies frequencies;
  double to_epoch; ///< from this boundary to the epoch, rad
  ShearingBox box;
  double offset;           ///< the box's shear offset at this boundary, m
  std::int64_t step;       ///< steps done
  double time = 0.0;       ///< since the run began, rad
  Communicator ranks = {}; ///< of many each has its own particles

  /// Turns elements at the epoch back to this boundary.
  Rotation rotation() const { return {frequencies, -to_epoch}; }
};

class Force {
public:
  virtual ~Force() = default;

  /// Its table in the scene, and its name in checkpoints, in the split of the time and in the energy budget.
  virtual std::string name() const = 0;

  /// Steps from one kick to the next. Runs stop and write where self-gravity's kicks end, so an external force must
  /// kick as often or in a divisor of that: 1 unless there is a reason.
  virtual std::int64_t kick_every() const { return 1; }

  /// Writes each particle's acceleration (m rad⁻²), in the order of the particles. Collective. The bits must depend on
  /// the particles and the step alone, never on threads or memory order, or a restart would not go on as the run did.
  virtual void accelerate(const Boundary& boundary, std::span<Vec3> accelerations) = 0;

  /// The energy and the stress of the particles in their own field; none of a force that has none, or no measure of
  /// it. Collective, and changes no bit of what comes.
  virtual std::optional<GravityEnergy> energy(const Boundary&) { return std::nullopt; }
};

/// What a force may need to know when a run begins or goes on. It is gone when the force has been made.
struct ForceContext {
  std::span<const double> masses; ///< kg, in the order of the particles
  ShearingBox box;
  double orbital_frequency = 0.0; ///< rad/s
  std::uint64_t seed = 1;
  Communicator ranks = {}; ///< of many each has its own particles, and makes each force at the same time
};

/// A force that a scene can ask for by a table of its own: that table's name, its keys, and how it is made from them.
struct ForceEntry {
  const char* table;
  std::vector<Key> keys;
  std::unique_ptr<Force> (*make)(const Parameters& parameters, const ForceContext& context);
  /// Throws UsageError where the values do not go with a box of that radial size; null: they always do. `make` checks
  /// the same, for boxes that the scene does not know.
  void (*check)(const Parameters& parameters, double size_x) = nullptr;
};

/// All forces but self-gravity, whose settings have a type of their own (self_gravity.hpp) because solvers are chosen,
/// measured and tuned by them. A new force is one more entry here.
const std::vector<ForceEntry>& external_forces();

} // namespace keeler
