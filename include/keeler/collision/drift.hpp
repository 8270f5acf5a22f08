// The drift phase: between two kicks particles follow their epicycles and collide as hard spheres, at exact times on
// the curved paths, in the order of events.hpp (event-driven dynamics).
//
// Candidate pairs come from neighbour lists that last many steps. After a contact, the next contacts of both particles
// are predicted from their new orbits. The result is that of the sequential order for any number of threads:
// docs/dev/drift.md.
#pragma once

#include <keeler/collision/settings.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <memory>
#include <span>

namespace keeler {
class FieldTable;
} // namespace keeler

namespace keeler::finders {
class Finder;
struct DriftStep;
struct FinderResult;
struct Query;
} // namespace keeler::finders

namespace keeler::decomposition {
struct GhostLayer;
} // namespace keeler::decomposition

namespace keeler::collision {

class DriftEngine;
struct DriftCosts;
struct NeighbourAudit;

/// Counts and sums over collisions; each step's sums are exact and rounded once. Energies in kg m² rad⁻².
struct CollisionTally {
  std::uint64_t fast = 0;       ///< collisions faster than v_cut
  std::uint64_t slow = 0;       ///< contacts slower than v_cut, bounced elastically
  std::uint64_t unresolved = 0; ///< of both, contacts slower than what one kick of the pair's own gravity gives them
  std::uint64_t gave_up = 0;    ///< searches that a finder abandoned: contacts may have been lost
  double energy_lost = 0.0;     ///< dissipated
  double momentum_flux = 0.0;   ///< Σ (x_j − x_i)(p_y gained by j), kg m² rad⁻¹: the collisional viscosity
  double azimuthal_gain = 0.0;  ///< gain of Σ m c_y²: the translational viscosity (docs/dev/diagnostics.md)

  void list_fields(FieldTable& table); ///< adds each of them
};

/// Returns the gain of Σ m (½κ²e² + ½ν²i²) and of the energy of spin by collisions, kg m² rad⁻².
inline double epicyclic_gain(const CollisionTally& tally, const Frequencies& f) {
  const double shear = f.shear();
  return shear * tally.momentum_flux + shear / (f.kappa * f.kappa) * tally.azimuthal_gain - tally.energy_lost;
}

/// The interval between two kicks of self-gravity that a drift is a part of. Velocities of the drift are those of its
/// middle; contacts need those of their own time (docs/theory/README.md).
struct KickInterval {
  std::span<const Vec3> accelerations; ///< of the kick at its begin, by particle, m rad⁻²; empty: no gravity
  double middle = 0.0;                 ///< rad from the epoch
  /// By particle: does it rest on another one? Its velocity in the drift is the true one. Empty: none does.
  std::span<const std::uint8_t> at_rest = {};
};

/// One collision.
struct CollisionRecord {
  double time;                       ///< relative to the middle of the step, rad
  std::uint64_t low_id;              ///< the lower id
  std::uint64_t high_id;             ///< the higher id
  Image image;                       ///< of the particle with the higher id
  double normal_speed;               ///< approach speed that its rebound follows from, m rad⁻¹
  bool fast;                         ///< faster than v_cut
  double tangential_speed = 0.0;     ///< of the centres before the contact, in the rotating frame, m rad⁻¹
  double energy_lost = 0.0;          ///< kg m² rad⁻²; of a contact that kicks do not resolve, of either sign
  double radius_sum = 0.0;           ///< m
  Vec3 contact_point = Vec3::Zero(); ///< on the surface of the particle with the lower id, as that is stored, m
  Vec3 normal = Vec3::Zero();        ///< unit vector along the line of centres, from the lower id to the higher one
  Vec3 impulse = Vec3::Zero();       ///< that the particle with the higher id got, friction included, kg m rad⁻¹
};

/// Observes drifts, and may choose how they are carried out: for measurements and tests. The result is the same.
class DriftObserver {
public:
  virtual ~DriftObserver() = default;

  /// True: the finder gets all pairs that the cells of a grid hold, without rejection of any first.
  virtual bool wants_every_candidate() const { return false; }
  /// Returns the number of domains for contacts, wherever that is allowed; 0: as many as pay.
  virtual std::size_t wants_domains() const { return 0; }
  /// Returns a finder in place of the settings' one, or nullptr. Constant within a step.
  virtual finders::Finder* replacement_finder() { return nullptr; }
  /// True: begins() to changed() are called, one at a time, in an order that no number of threads changes.
  virtual bool wants_events() const { return true; }
  /// True: recorded() is called. Steps keep their threads.
  virtual bool wants_records() const { return false; }

  virtual void begins(const finders::DriftStep&) {}                             ///< before the first search of a step
  virtual void searched(const finders::Query&, const finders::FinderResult&) {} ///< a search, and what it has found
  virtual void collided(const CollisionRecord&) {}                              ///< a contact that has been carried out
  virtual void changed(std::size_t /*particle*/) {} ///< the velocity of a particle has changed
  /// Receives all contacts of a step at its end, in the order of events.
  virtual void recorded(std::span<const CollisionRecord>) {}
};

/// Two particles that have touched slowly, by index, the lower id first.
struct SlowPair {
  std::uint32_t low;  ///< has the lower id
  std::uint32_t high; ///< has the higher id
  float kicks;        ///< approach speed over that which a kick of the pair's own gravity gives
};

/// Carries out the collisions of drifts, one drift per call.
class DriftPhase {
public:
  /// `step` is the length h of a drift (rad). Precondition: h > 0. Throws UsageError for an unknown finder.
  DriftPhase(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency, double step);

  /// Sets, for the following steps, the length h of a drift (rad), and G times the kick interval (m³ kg⁻¹ rad⁻¹; 0
  /// without self-gravity), which decides what contacts kicks do not resolve. `rest_pull`, in the same unit, decides
  /// which contacts slow_pairs() lists. Preconditions: h > 0; pulls are not negative.
  void set_step(double step, double kick_pull, double rest_pull = 0.0);

  /// Returns the pairs of the last step that touched more slowly than rest_pull (m_i + m_j) / (r_i + r_j)², in the
  /// order of events; a pair may be there more than once.
  std::span<const SlowPair> slow_pairs() const;

  /// Returns gravity's work in the last step on the velocities that contacts changed, beyond what its kicks do
  /// (kg m² rad⁻²).
  double kick_work() const;

  ~DriftPhase();
  DriftPhase(DriftPhase&& other) noexcept;            ///< leaves `other` unusable
  DriftPhase& operator=(DriftPhase&& other) noexcept; ///< leaves `other` unusable

  /// Carries out all collisions in [−h/2, h/2) around the epoch of the elements; `offset` is the box's shear offset at
  /// the epoch. The elements stay at their epoch. `undisturbed` is a promise that saves work: since the last call the
  /// particles have only moved on by one step and been wrapped. Throws InvariantError when elements are not finite,
  /// when particles go too far for the box or one collides more than 100,000 times in the step; Interrupted
  /// (interrupt.hpp). Precondition: accelerations of all particles or of none.
  void collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally,
               bool undisturbed = false, const KickInterval& gravity = {});

  /// Carries out a step that ranks share: own particles and ghosts (decomposition/ghost_layer.hpp), which have the bits
  /// of their owners. The own particles become what they would on one rank, each contact counts on all ranks, and
  /// `ghosts` counts those of each own particle.
  /// Returns false on all, with everything as it was, if an own particle of one went farther than the margin.
  /// Preconditions: all ranks call it; the finder is exact; no observer wants events, and there is no audit.
  bool collide_distributed(Particles& particles, decomposition::GhostLayer& ghosts, const Communicator& ranks,
                           const ShearingBox& box, double offset, CollisionTally& tally,
                           const KickInterval& gravity = {});

  const finders::Finder& finder() const; ///< the one in use, which may be the observer's
  DriftCosts costs() const;              ///< since construction

  /// Releases what only the contacts of the last step needed, and the pairs that were picked for steps between two
  /// kicks: before forces are computed, which need memory of their own.
  void release_contacts();

  /// Releases memory that the next steps would need again: before a large allocation.
  void release();

  /// Registers an observer for the following steps; nullptr removes it.
  void observe(DriftObserver* observer);

  /// Compares neighbours with the plain search in the following steps; nullptr ends that.
  void audit(NeighbourAudit* audit);

  /// Returns, when collide() has thrown, the time of the last contact that it had carried out (rad from the epoch).
  /// Until then all particles have followed their present elements.
  double reached() const;

private:
  std::unique_ptr<DriftEngine> engine_;
};

} // namespace keeler::collision

namespace keeler {
using collision::CollisionTally;
} // namespace keeler
