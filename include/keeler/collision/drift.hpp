// The drift phase: between two kicks, particles ride their epicycles and meet as hard spheres, at exact times on the
// curved paths, in the order of events.hpp.
//
// Candidates come from neighbour lists that serve for many steps. A particle that was hit is searched again from its
// new orbit. The answer is that of the sequential order, for any number of threads: docs/dev/drift.md.
#pragma once

#include <keeler/collision/costs.hpp>
#include <keeler/collision/settings.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/core/field_table.hpp>
#include <keeler/decomposition/ghost_layer.hpp>
#include <keeler/finders/finder.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <memory>
#include <span>

namespace keeler {

struct Contact;
class DriftEngine;
struct NeighbourAudit;

/// What collisions did; each step's sums are exact and rounded once. Energies in kg m² rad⁻².
struct CollisionTally {
  std::uint64_t fast = 0;       ///< collisions faster than v_cut
  std::uint64_t slow = 0;       ///< contacts slower than v_cut, bounced elastically
  std::uint64_t unresolved = 0; ///< of both, contacts slower than what one kick of the pair's own gravity gives them
  std::uint64_t gave_up = 0;    ///< searches that a finder abandoned: contacts may have been lost
  double energy_lost = 0.0;     ///< dissipated
  double momentum_flux = 0.0;   ///< Σ (x_j − x_i)(p_y gained by j), kg m² rad⁻¹: the collisional viscosity
  double azimuthal_gain = 0.0;  ///< what Σ m c_y² gained: the translational viscosity (docs/dev/diagnostics.md)

  void list_fields(FieldTable& table);
};

/// What the collisions added to Σ m (½κ²e² + ½ν²i²), and to the spins of rough particles, kg m² rad⁻².
inline double epicyclic_gain(const CollisionTally& tally, const Frequencies& f) {
  const double shear = f.shear();
  return shear * tally.momentum_flux + shear / (f.kappa * f.kappa) * tally.azimuthal_gain - tally.energy_lost;
}

/// One collision as it happened.
struct CollisionRecord {
  double time; ///< relative to the middle of the step, rad
  std::uint64_t low_id, high_id;
  Image image;                   ///< of the particle with the higher id
  double normal_speed;           ///< approach speed, m rad⁻¹
  bool fast;                     ///< faster than v_cut
  double tangential_speed = 0.0; ///< before the contact, of centre against centre in the rotating frame, m rad⁻¹
  double energy_lost = 0.0;      ///< kg m² rad⁻²
  double radius_sum = 0.0;       ///< m
  Vec3 place = Vec3::Zero();     ///< where the spheres touch, beside the particle with the lower id as it is stored, m
};

/// Looks on while drifts are carried out, and may say how: for measurements and tests. What happens is the same.
class DriftObserver {
public:
  virtual ~DriftObserver() = default;

  /// Hand all that a grid's cells hold to the finder, without rejecting any first.
  virtual bool wants_every_candidate() const { return false; }
  /// So many domains for contacts on several threads, wherever that is allowed; 0: as many as pay.
  virtual std::size_t wants_domains() const { return 0; }
  /// A finder in place of the settings' one, or null.
  virtual Finder* stand_in() { return nullptr; }
  /// Whether the calls below are wanted. They come one at a time, in an order that no number of threads changes.
  virtual bool looks_on() const { return true; }
  /// Whether recorded() is wanted. It costs no threads.
  virtual bool wants_records() const { return false; }

  virtual void begins(const DriftStep&) {}
  virtual void searched(const Query&, const FinderResult&) {}
  virtual void collided(const CollisionRecord&) {}
  virtual void changed(std::size_t /*particle*/) {} ///< its velocity
  /// At the end of each step: all its contacts in the order of events.
  virtual void recorded(std::span<const CollisionRecord>) {}
};

/// Two particles that have touched slowly, by place, the lower id first.
struct SlowPair {
  std::uint32_t low, high;
  float kicks; ///< how fast, in what a kick of the pair's own gravity gives
};

class DriftPhase {
public:
  /// `step` is the length h of a drift (rad). Throws UsageError for an unknown finder.
  DriftPhase(const CollisionSettings& settings, const Frequencies& frequencies, double orbital_frequency, double step);

  /// From the next step on: the length h of a drift (rad), and G times the kick interval (m³ kg⁻¹ rad⁻¹; 0 without
  /// self-gravity), which tells what contacts kicks do not resolve. `rest_pull`, in the same way, tells which contacts
  /// slow_pairs() lists.
  void set_pace(double step, double kick_pull, double rest_pull = 0.0);

  /// Pairs of the last step that touched more slowly than rest_pull (m_i + m_j) / (r_i + r_j)², in the order of events;
  /// some may be there more than once.
  std::span<const SlowPair> slow_pairs() const;

  ~DriftPhase();
  DriftPhase(DriftPhase&& other) noexcept;
  DriftPhase& operator=(DriftPhase&& other) noexcept;

  /// Carries out all collisions in [−h/2, h/2) around the epoch of the elements; `offset` is the box's shear offset at
  /// the epoch. The elements stay at their epoch. `undisturbed` is a promise that spares work: since the last call the
  /// particles have moved on by one step and been wrapped, and nothing else. Throws InvariantError when elements are
  /// not finite, when particles go too far for the box or one collides more than 100,000 times in the step; Interrupted
  /// (interrupt.hpp).
  void collide(Particles& particles, const ShearingBox& box, double offset, CollisionTally& tally,
               bool undisturbed = false);

  /// The same of a step that ranks share: own particles and copies (decomposition/ghost_layer.hpp), which have the bits
  /// of their owners. All ranks call it at once, with an exact finder and no onlookers. The own particles become what
  /// they would on one rank, and each contact counts on all ranks. Returns false on all, with everything as it was,
  /// where an own particle of one went farther than the margin.
  bool collide_distributed(Particles& particles, const GhostLayer& borders, const Communicator& ranks,
                           const ShearingBox& box, double offset, CollisionTally& tally);

  const Finder& finder() const;
  DriftCosts costs() const;

  /// Gives memory back that the next steps would need: before something large.
  void release();

  /// From now on; null: nobody looks on.
  void observe(DriftObserver* observer);

  /// From now on neighbours are held against the plain search; null: no more.
  void audit(NeighbourAudit* audit);

  /// When collide() has thrown: the time, from the epoch on, of the last contact that it had carried out (rad). Until
  /// then all particles have gone the way of their present elements.
  double reached() const;

private:
  std::unique_ptr<DriftEngine> engine_;
};

} // namespace keeler
