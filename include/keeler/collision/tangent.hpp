// The straight line that a particle's path touches at the epoch (mid-step), and the test that a straight line allows:
// no path leaves its tangent by more than A t²/2, so a pair whose tangents stay farther apart than contact plus that is
// a certified miss, without a sine or cosine.
#pragma once

#include <keeler/particles/store.hpp>

#include <algorithm>

namespace keeler {

/// All that the test needs of a particle, in one line of cache.
struct alignas(64) Tangent {
  Vec3 position, velocity; ///< m, m rad⁻¹, at the epoch
  double acceleration;     ///< A: |a| <= A at all times, rounded up
  double radius;           ///< m
};
static_assert(sizeof(Tangent) == 64);

inline Tangent tangent_of(const Body& body, const Frequencies& f) {
  constexpr double up = 1.0 + 1e-9;
  static const Rotation at_epoch;
  const Elements& el = body.elements;
  const State s = state_at(el, f, at_epoch);
  const double nu2 = f.nu * f.nu;
  return {s.position, s.velocity, up * std::hypot(2.0 * f.kappa * el.eccentricity(), nu2 * el.inclination()),
          body.radius};
}

/// How two tangents are compared within one step.
struct TangentTest {
  double shear;    ///< S
  double end;      ///< of the step, rad after the epoch
  double longest;  ///< the longest time from the epoch
  double rounding; ///< allowance for the rounding of coordinates, m

  /// False only when the straight-line closest approach over [start, end], with all that curvature and rounding can
  /// add, stays outside contact. The shift, at the epoch, is that of the image of `b`.
  bool may_touch(const Tangent& a, const Tangent& b, double shift_x, double shift_y, double start) const {
    constexpr double up = 1.0 + 1e-9;
    const Vec3 d = b.position + Vec3(shift_x, shift_y, 0.0) - a.position;
    Vec3 v = b.velocity - a.velocity;
    v.y() -= shear * shift_x;
    const double bend = (a.acceleration + b.acceleration) * (0.5 * longest * longest);
    const double far = a.radius + b.radius + bend + rounding, far2 = far * far * up;
    const double d2 = d.squaredNorm(), dv = d.dot(v);
    if (d2 - 2.0 * up * std::fabs(dv) * longest > far2) // |d + v t|² is no less than this: most pairs end here
      return false;
    const double v2 = v.squaredNorm();
    const double closest = v2 > 0.0 ? std::clamp(-dv / v2, start, end) : start;
    return !((d + closest * v).squaredNorm() > far2);
  }
};

} // namespace keeler
