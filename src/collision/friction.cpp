#include <keeler/collision/friction.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::collision {
namespace {

constexpr double rolling = 2.0 / 7.0; // tangential effective mass over the reduced mass: 1/(1 + 5/2)
constexpr double inertia = 2.0 / 5.0; // moment of inertia over m r²
const Vec3 frame_spin(0.0, 0.0, 1.0); // of Hill's frame: Ω

} // namespace

Sliding slide(const Friction& friction, const Touch& touch, double normal_impulse) {
  assert(normal_impulse >= 0.0 && std::fabs(touch.normal.squaredNorm() - 1.0) < 1e-9);
  const Body &a = touch.a, &b = touch.b;
  const Vec3 spins = a.radius * (touch.spin_a - frame_spin) + b.radius * (touch.spin_b - frame_spin);
  const Vec3 slip = touch.velocity - touch.velocity.dot(touch.normal) * touch.normal - spins.cross(touch.normal);
  const double speed = slip.norm();
  if (!(speed > 0.0))
    return {Vec3::Zero(), 0.0};
  const double mass = rolling * (a.mass * b.mass / (a.mass + b.mass));
  const double change = std::min((1.0 - friction.tangential_restitution) * speed,
                                 friction.coefficient * normal_impulse / mass); // of the slip
  return {(-mass * change / speed) * slip, mass * change * (speed - 0.5 * change)};
}

Vec3 spin_change(const Body& body, const Vec3& normal, const Vec3& impulse) {
  return (-1.0 / (inertia * body.mass * body.radius)) * normal.cross(impulse);
}

} // namespace keeler::collision
