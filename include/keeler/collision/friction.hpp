// Rough spheres: what a contact does along their surfaces, and to their spins. Homogeneous spheres, whose moment of
// inertia is 2/5 m r².
#pragma once

#include <keeler/particles/store.hpp>

#include <limits>

namespace keeler {

struct Friction {
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  double tangential_restitution = 1.0; ///< ε_t in [−1, 1]: the slip of the surfaces afterwards over that before
  double coefficient = unlimited;      ///< Coulomb's: the impulse along the surfaces is at most this × the normal one
};

/// Two spheres that touch, at one instant in Hill's frame. Spins are angular velocities against the stars, rad⁻¹.
struct Touch {
  const Body &a, &b;
  Vec3 normal;   ///< from a to b
  Vec3 velocity; ///< of b's centre against a's, before the contact, m rad⁻¹
  Vec3 spin_a, spin_b;
};

struct Sliding {
  Vec3 impulse;       ///< on b along the surfaces, kg m rad⁻¹; a gets the opposite
  double energy_lost; ///< of what the centres and the spins have, kg m² rad⁻²
};

/// What friction does beside a normal impulse of this size (kg m rad⁻¹). Walton & Braun (1986): the slip
///   u = v_b − v_a − [r_a (ω_a − Ω) + r_b (ω_b − Ω)] × n, its part along the surfaces
/// becomes ε_t u by an impulse −(2/7) μ (1 − ε_t) u, μ the reduced mass (2/7 holds for any masses and radii), or by
/// less where Coulomb's law allows only less: then the surfaces slide all through the contact.
Sliding slide(const Friction& friction, const Touch& touch, double normal_impulse);

/// What that impulse on b at the point of contact, and its opposite on a, does to the spin of either: −r/I n × impulse.
Vec3 spin_change(const Body& body, const Vec3& normal, const Vec3& impulse);

} // namespace keeler
