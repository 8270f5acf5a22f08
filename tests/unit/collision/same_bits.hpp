// Comparison of states, sums and contacts to the last bit.
#pragma once

#include "unit/collision/ring.hpp"

#include <algorithm>
#include <cstring>

namespace keeler::test {

inline bool same_bits(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

inline bool same_bits(const Particles& a, const Particles& b) {
  const std::vector<Body> left = by_id(a), right = by_id(b);
  if (a.rough)
    for (std::size_t k = 0; k < a.size(); ++k)
      if (const auto j = static_cast<std::size_t>(std::find(b.ids.begin(), b.ids.end(), a.ids[k]) - b.ids.begin());
          a.spins[k] != b.spins[j])
        return false;
  return left.size() == right.size() && a.rough == b.rough &&
         (left.empty() || std::memcmp(left.data(), right.data(), left.size() * sizeof(Body)) == 0);
}

inline bool same_bits(const CollisionTally& a, const CollisionTally& b) {
  return a.fast == b.fast && a.slow == b.slow && a.gave_up == b.gave_up && same_bits(a.energy_lost, b.energy_lost) &&
         same_bits(a.momentum_flux, b.momentum_flux) && same_bits(a.azimuthal_gain, b.azimuthal_gain);
}

/// Compares all fields to the bit.
inline bool same_bits(const collision::CollisionRecord& a, const collision::CollisionRecord& b) {
  return same_bits(a.time, b.time) && a.low_id == b.low_id && a.high_id == b.high_id && a.image == b.image &&
         same_bits(a.normal_speed, b.normal_speed) && a.fast == b.fast &&
         same_bits(a.tangential_speed, b.tangential_speed) && same_bits(a.energy_lost, b.energy_lost) &&
         same_bits(a.radius_sum, b.radius_sum) && a.contact_point == b.contact_point && a.normal == b.normal &&
         a.impulse == b.impulse;
}

} // namespace keeler::test
