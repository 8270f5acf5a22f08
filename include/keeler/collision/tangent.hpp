// The straight line that a particle's path touches at the epoch (mid-step), and the test that a straight line allows:
// no path leaves its tangent by more than A t²/2, so a pair whose tangents stay farther apart than contact plus that is
// a certified miss, without a sine or cosine.
#pragma once

#include <keeler/orbit/elements.hpp>

#include <algorithm>

namespace keeler {

/// Position (m) and velocity (m rad⁻¹) at the epoch, and what bounds the departure from them.
struct Tangent {
  Vec3 position, velocity;
  double eccentricity; ///< m
  double acceleration; ///< A: |a| <= A at all times, rounded up
};

inline Tangent tangent_of(const Elements& el, const Frequencies& f) {
  constexpr double up = 1.0 + 1e-9;
  static const Rotation at_epoch;
  const State s = state_at(el, f, at_epoch);
  const double e = el.eccentricity(), i = el.inclination();
  return {s.position, s.velocity, e, up * std::hypot(2.0 * f.kappa * e, f.nu * f.nu * i)};
}

/// How two tangents are compared within one step.
struct TangentTest {
  double shear;       ///< S
  double end;         ///< of the step, rad after the epoch
  double half_square; ///< half the square of the longest time from the epoch
  double rounding;    ///< allowance for the rounding of coordinates, m

  /// False only when the straight-line closest approach over [start, end], with all that curvature and rounding can
  /// add, stays outside contact at distance `reach`. The shift, at the epoch, is that of the image of `b`.
  bool may_touch(const Tangent& a, const Tangent& b, double shift_x, double shift_y, double reach, double start) const {
    constexpr double up = 1.0 + 1e-9;
    const Vec3 d = b.position + Vec3(shift_x, shift_y, 0.0) - a.position;
    Vec3 v = b.velocity - a.velocity;
    v.y() -= shear * shift_x;
    const double v2 = v.squaredNorm();
    const double closest = v2 > 0.0 ? std::clamp(-d.dot(v) / v2, start, end) : start;
    const double far = reach + (a.acceleration + b.acceleration) * half_square + rounding;
    return !((d + closest * v).squaredNorm() > far * far * up);
  }
};

} // namespace keeler
