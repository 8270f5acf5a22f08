// Friction between rough spheres: the tangential impulse of a contact and the change of spins. Spheres are homogeneous,
// with a moment of inertia of 2/5 m r².
#pragma once

#include <keeler/collision/settings.hpp>
#include <keeler/particles/store.hpp>

namespace keeler::collision {

/// Two spheres in contact, at one instant in Hill's frame. Spins are angular velocities in the inertial frame, rad⁻¹.
struct Touch {
  const Body &a, &b;
  Vec3 normal;   ///< unit vector from a to b
  Vec3 velocity; ///< of b's centre relative to a's, before the contact, m rad⁻¹
  Vec3 spin_a, spin_b;
};

struct Sliding {
  Vec3 impulse;       ///< tangential, on b, kg m rad⁻¹; a gets the opposite
  double energy_lost; ///< by motion of the centres and spins, kg m² rad⁻²
};

/// Returns what friction does beside a normal impulse (kg m rad⁻¹). Walton & Braun (1986): the slip
///   u = v_b − v_a − [r_a (ω_a − Ω) + r_b (ω_b − Ω)] × n, tangential part,
/// becomes ε_t u by an impulse −(2/7) μ (1 − ε_t) u, μ the reduced mass (2/7 holds for any masses and radii), or by
/// less where Coulomb's law allows only less: then the surfaces slide throughout the contact. Preconditions: the
/// impulse is not negative; touch.normal has length 1.
Sliding slide(const Friction& friction, const Touch& touch, double normal_impulse);

/// Returns the change of either sphere's spin by that impulse on b at the point of contact and its opposite on a:
/// −r/I n × impulse.
Vec3 spin_change(const Body& body, const Vec3& normal, const Vec3& impulse);

} // namespace keeler::collision
