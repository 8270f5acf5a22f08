// Contacts at rest: pairs of spheres with a rebound that a single kick reverses. The drift cannot resolve them: they
// would bounce in each kick interval again, and rattle. This solver holds each such pair at contact until the next
// kick, by an impulse along the line of centres that acts together with the kick (non-smooth contact dynamics: Moreau
// 1988, Jean 1999; Preclik & Rüde 2015; the scheme is SHAKE, Ryckaert et al. 1977, for constraints that only push).
// docs/dev/contact-solver.md.
//
// Invariants: pairs are sorted by ids, low < high; impulses push and never pull; no result depends on memory order or
// threads; RestingState holds all that a restart needs.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/collision/friction.hpp>
#include <keeler/comm/communicator.hpp>
#include <keeler/contact_solver/resting_state.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace keeler::contact_solver {

/// The part that one force has in the kicks at a boundary.
struct KickPart {
  std::span<const Vec3> accelerations; ///< m rad⁻², in the order of the particles
  double before = 0.0, after = 0.0;    ///< half kick intervals that end and begin here, rad
  double* work = nullptr;              ///< the force's energy account, kg m² rad⁻²
  double* azimuthal_gain = nullptr;
};

/// The particles at a boundary between two steps, where a kick interval ends and another begins.
struct RestingStep {
  Particles& particles;
  Frequencies frequencies;
  ShearingBox box;
  double epoch_offset = 0.0; ///< the box's shear offset at the epoch of the elements, m
  double to_epoch = 0.0;     ///< time from the boundary to the epoch, rad
  double interval = 0.0;     ///< time to the next kick, rad
  double gravity = 0.0;      ///< Newton's constant, m³ kg⁻¹ rad⁻²
  std::span<const KickPart> kicks;
};

class RestingContacts {
public:
  RestingContacts();
  ~RestingContacts();
  RestingContacts(RestingContacts&& other) noexcept;
  RestingContacts& operator=(RestingContacts&& other) noexcept;

  /// Records a pair that touched slowly in the current kick interval. Precondition: the pair's low id is the smaller.
  void note(const Particles& particles, const collision::SlowPair& pair);

  /// True if there is nothing to do: no pair rests and none was noted.
  bool idle(const RestingState& state) const { return state.pairs.empty() && noted_.empty(); }

  /// Selects the pairs at rest, applies friction to rough ones, finds the impulses for the kick, and applies the first
  /// half of them. Precondition: the half kicks that end an interval have been applied. Throws InvariantError if no
  /// impulses exist.
  void persist(RestingState& state, const RestingStep& step, const std::optional<collision::Friction>& friction,
               CollisionTally& tally);

  /// Applies the second half, and marks the particles that impulses act on in `at_rest` (by particle). Precondition:
  /// the half kicks that begin the next interval have been applied.
  void persist_second_half(RestingState& state, const RestingStep& step, CollisionTally& tally,
                           std::span<std::uint8_t> at_rest);

  /// Replaces the pairs recorded on each rank by those of all ranks; collective. From then on the order in memory of
  /// the particles that were recorded does not matter.
  void share_noted(const Communicator& ranks);
  /// Returns the ids, in increasing order, of all particles that persist() and persist_second_half() read and change.
  std::vector<std::uint64_t> member_ids(const RestingState& state) const;

  /// Tells that the particles' order in memory has changed.
  void reordered() { indices_known_ = false; }

private:
  struct Noted {
    RestingPair ids;
    std::uint32_t low, high; // indices of the particles
  };
  struct Work;

  void sort_noted();

  std::vector<Noted> noted_;
  bool indices_known_ = false;
  std::unique_ptr<Work> work_; // null while no pair rests
};

} // namespace keeler::contact_solver
