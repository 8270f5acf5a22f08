// The collision settings of a scene.
#pragma once

#include <keeler/collision/restitution.hpp>

#include <limits>
#include <optional>
#include <string>

namespace keeler::collision {

/// Friction between rough spheres (friction.hpp has its law).
struct Friction {
  static constexpr double unlimited = std::numeric_limits<double>::infinity(); ///< a coefficient without any limit

  double tangential_restitution = 1.0; ///< ε_t in [−1, 1]: slip velocity of the surfaces after over before
  double coefficient = unlimited;      ///< Coulomb's: tangential impulse ≤ coefficient × normal impulse
};

/// How contacts are found, and what they do to the particles.
struct CollisionSettings {
  std::string finder = "certified";                       ///< a name of finder_table()
  RestitutionLaw restitution = constant_restitution(0.5); ///< normal; for approaches faster than v_cut
  double elastic_below = 1e-2;      ///< v_cut in units of (r_i + r_j) Omega / 2: slower contacts bounce elastically
  std::optional<Friction> friction; ///< none: smooth spheres, without spins

  /// Returns v_cut for a radius sum (m), m rad^-1.
  double cut_speed(double radius_sum) const { return 0.5 * elastic_below * radius_sum; }
  /// Returns v_cut/1000: a slower rebound would stay within the rounding of the contact, and so never end.
  double min_rebound(double radius_sum) const { return 1e-3 * cut_speed(radius_sum); }
};

/// The state of a pair after a contact.
struct Rebound {
  double speed; ///< normal speed afterwards, m rad^-1
  bool fast;    ///< the approach was faster than v_cut
};

/// Returns restitution times the approach speed (m rad^-1) above v_cut, the approach speed below it, and never less
/// than min_rebound() (for ε = 0, say).
Rebound rebound(const CollisionSettings& settings, double approach_speed, double radius_low, double radius_high,
                double orbital_frequency);

} // namespace keeler::collision
