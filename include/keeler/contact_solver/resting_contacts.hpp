// Contacts at rest: pairs of spheres whose rebound a single kick undoes. The drift cannot resolve them, since a kick
// would make them bounce once for each kick interval and dissipate what it has just given them. They carry the kick
// instead: impulses along the lines of centres, given together with it, hold each of these pairs at contact until the
// next kick (non-smooth contact dynamics: Moreau 1988, Jean 1999; Preclik & Rüde 2015; the scheme is SHAKE, Ryckaert et
// al. 1977, for constraints that only push). docs/dev/resting.md.
//
// Invariants: pairs are sorted by ids, low < high; impulses push and never pull; nothing here depends on memory order
// or threads; what a restart needs is in RestingState.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/collision/friction.hpp>
#include <keeler/core/field_table.hpp>
#include <keeler/hill/shearing_box.hpp>
#include <keeler/particles/store.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace keeler {

/// Two particles by id, the lower one first.
struct RestingPair {
  std::uint64_t low = 0, high = 0;
  friend bool operator==(const RestingPair&, const RestingPair&) = default;
  friend bool operator<(const RestingPair& a, const RestingPair& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  }
};

/// What a pair carries at this boundary between two steps.
struct RestingLoad {
  Vec3 separation = Vec3::Zero(); ///< from the lower id to the other, m
  double impulse = 0.0;           ///< that pushes them apart, of a whole kick, kg m rad⁻¹
};

/// Of a run, to go on from.
struct RestingState {
  std::vector<RestingPair> pairs;
  std::vector<RestingLoad> loads; ///< one for each
  double strongest = 0.0;         ///< of the impulses, in kicks of the pair's own gravity
  double work = 0.0; ///< of the impulses on the motion of the pairs relative to each other, kg m² rad⁻²

  /// Contacts of anybody slower than so many kicks of the pair's own gravity may come to rest.
  static constexpr double slow = 4.0;
  /// The same for those who touch a particle at rest, which may press as hard as others do.
  double looked_at() const { return slow * std::max(1.0, strongest); }

  void list_fields(FieldTable& table);
};

/// A force's share in the kicks at a boundary.
struct KickPart {
  std::span<const Vec3> accelerations; ///< m rad⁻², in the order of the particles
  double before = 0.0, after = 0.0;    ///< half kick intervals that end and begin here, rad
  double* work = nullptr;              ///< booked for it, kg m² rad⁻²
  double* azimuthal_gain = nullptr;
};

/// The particles at a boundary between two steps, where a kick interval ends and another begins.
struct RestingStep {
  Particles& particles;
  Frequencies frequencies;
  ShearingBox box;
  double epoch_offset = 0.0; ///< the box's shear offset at the epoch of the elements, m
  double to_epoch = 0.0;     ///< from the boundary, rad
  double interval = 0.0;     ///< to the next kick, rad
  double gravity = 0.0;      ///< Newton's constant, m³ kg⁻¹ rad⁻²
  std::span<const KickPart> kicks;
};

/// What the last carry() took.
struct RestingCosts {
  std::size_t contacts = 0, iterations = 0;
};

class RestingContacts {
public:
  RestingContacts();
  ~RestingContacts();
  RestingContacts(RestingContacts&& other) noexcept;
  RestingContacts& operator=(RestingContacts&& other) noexcept;

  /// A pair that has touched slowly in the kick interval at hand.
  void note(const Particles& particles, const SlowPair& pair);

  /// Whether there is nothing to do: nothing rests, and nothing was noted.
  bool idle(const RestingState& state) const { return state.pairs.empty() && noted_.empty(); }

  /// To be called after the half kicks that end an interval: finds who rests, what each pair has to carry through the
  /// kick, rubs rough surfaces, and gives the first half of the impulses. Throws InvariantError when no impulses are
  /// found.
  void carry(RestingState& state, const RestingStep& step, const std::optional<Friction>& friction,
             CollisionTally& tally);

  /// To be called after the half kicks that begin the next interval: the second half.
  void carry_on(RestingState& state, const RestingStep& step, CollisionTally& tally);

  /// The order of the particles in memory is another.
  void reordered() { places_known_ = false; }

  const RestingCosts& costs() const;

private:
  struct Noted {
    RestingPair ids;
    std::uint32_t low, high; // places in memory
  };
  struct Work;
  std::vector<Noted> noted_;
  bool places_known_ = false;
  std::unique_ptr<Work> work_; // only where something rests
};

} // namespace keeler
