// What a contact does to the relative velocity along its line of centres when gravity acts in kicks.
//
// During a drift a particle has the velocity of the middle of the kick interval. At a time δ after the middle its true
// velocity differs by a δ, a its acceleration. So the laws of contact get u = v + g δ, with v the relative velocity of
// the drift and g the pair's relative acceleration, and the impulse that they give changes v. A contact is *resolved*
// if the pair approaches in u, and if it then separates in the drift. Other pairs are pressed together by the kick
// alone: they get the velocity of the drift, in which they must not overlap. So do particles that rest on others: the
// impulses of their contacts act with each kick. docs/theory/README.md has the derivation.
#pragma once

#include <keeler/collision/drift.hpp>
#include <keeler/collision/settings.hpp>

#include <cstdint>

namespace keeler::collision {

/// The two particles of a contact, by index.
struct TouchingPair {
  std::uint32_t low, high;
  double radius_low, radius_high; ///< m
};

/// How a contact turns the approach of a pair into its rebound.
struct ContactLaw {
  Vec3 velocity;           ///< relative velocity that the laws of contact get, m rad⁻¹
  double approach;         ///< normal speed before the contact, in that velocity
  Rebound rebound;         ///< in that velocity
  Vec3 lag = Vec3::Zero(); ///< g δ: true velocity less that of the drift, m rad⁻¹
  bool resolved = false;   ///< `velocity` is the true one

  /// True if the pair approaches. An inexact finder may call one that moves apart.
  bool acts() const { return approach > -rebound.speed; }
};

/// Returns the law of a contact at `time` (rad from the epoch). `drift_velocity` is that of the particle with the
/// higher id relative to the other one, and `normal` the unit vector from the other one to it.
inline ContactLaw contact_law(const CollisionSettings& settings, const KickInterval& gravity, double orbital_frequency,
                              const TouchingPair& pair, const Vec3& drift_velocity, const Vec3& normal, double time) {
  const auto rebound_of = [&](double approach) {
    return rebound(settings, approach, pair.radius_low, pair.radius_high, orbital_frequency);
  };
  ContactLaw law;
  const bool rests = !gravity.at_rest.empty() && (gravity.at_rest[pair.low] || gravity.at_rest[pair.high]);
  if (!gravity.accelerations.empty() && !rests) {
    const Vec3 g = gravity.accelerations[pair.high] - gravity.accelerations[pair.low];
    law.lag = (time - gravity.middle) * g;
    law.velocity = drift_velocity + law.lag;
    law.approach = -law.velocity.dot(normal);
    if (law.approach > 0.0) {
      law.rebound = rebound_of(law.approach);
      law.resolved =
          law.rebound.speed - law.lag.dot(normal) >= settings.min_rebound(pair.radius_low + pair.radius_high);
    }
  }
  if (!law.resolved) {
    law.velocity = drift_velocity;
    law.approach = -drift_velocity.dot(normal);
    law.rebound = rebound_of(law.approach);
  }
  return law;
}

} // namespace keeler::collision
