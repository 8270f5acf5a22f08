// Contacts at rest, as a run's state holds them: pairs of spheres with a rebound that a single kick reverses
// (docs/dev/contact-solver.md).
#pragma once

#include <keeler/core/vector.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace keeler {
class FieldTable;
} // namespace keeler

namespace keeler::contact_solver {

/// Two particles by id, the lower one first.
struct RestingPair {
  std::uint64_t low = 0;                                                    ///< the lower id
  std::uint64_t high = 0;                                                   ///< the higher id
  friend bool operator==(const RestingPair&, const RestingPair&) = default; ///< equal ids
  /// Orders pairs by the lower id, then by the higher one.
  friend bool operator<(const RestingPair& a, const RestingPair& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  }
};

/// A pair's contact at the boundary between two steps.
struct RestingLoad {
  Vec3 separation = Vec3::Zero(); ///< from the lower id to the higher one, m
  double impulse = 0.0;           ///< of the whole kick, pushes the two apart, kg m rad⁻¹
};

/// The contacts at rest of a run; part of its checkpoints.
struct RestingState {
  std::vector<RestingPair> pairs; ///< in increasing order
  std::vector<RestingLoad> loads; ///< one per pair
  double strongest = 0.0;         ///< largest impulse, in kicks of the pair's gravity
  double work = 0.0;              ///< of the impulses on the relative motion of the pairs, kg m² rad⁻²

  /// A contact slower than this, in kicks of the pair's gravity, may come to rest.
  static constexpr double slow = 4.0;
  /// Returns this limit for contacts with a particle at rest, which may press as hard as the strongest impulse.
  double slow_limit() const { return slow * std::max(1.0, strongest); }

  void list_fields(FieldTable& table); ///< adds everything that an exact restart needs
};

} // namespace keeler::contact_solver
