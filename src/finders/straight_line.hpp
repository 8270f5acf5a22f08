// The test of straight lines: a relative path deviates from its tangent at the epoch by at most A t²/2, so a pair with
// tangents farther apart than contact plus that is a proven miss, without a sine or cosine. All values come from
// the difference of the elements: a body is one cache line.
#pragma once

#include <keeler/particles/store.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::finders {

/// The test at times up to `end` after the epoch, all within `longest` (rad) of it; may_touch_soon() has separate
/// times.
struct StraightLineTest {
  Frequencies frequencies;
  double end = 0.0;
  double longest = 0.0;
  double allowance = 0.0; ///< added to contact, m: for rounding of coordinates, or a skin

  /// Returns false only if the closest approach of the straight lines over [start, end] stays outside contact plus
  /// bounds on curvature and rounding. The shift is that of the image of `b` at the epoch.
  bool may_touch(const Body& a, const Body& b, double shift_x, double shift_y, double start) const {
    const double shear = frequencies.shear(), kappa = frequencies.kappa, nu = frequencies.nu;
    const Elements el = b.elements - a.elements;
    const double gx = el.guiding_x + shift_x, gy = el.guiding_y + shift_y;
    const Vec3 d(gx - el.e_cos, gy + (2.0 / kappa) * el.e_sin, el.i_sin);
    const Vec3 v(kappa * el.e_sin, 2.0 * el.e_cos - shear * gx, nu * el.i_cos);
    const double half_square = 0.5 * longest * longest;
    // A² = (2κ e)² + (ν² i)²; A is no more than the sum of the four parts
    const double bound = 2.0 * kappa * (std::fabs(el.e_cos) + std::fabs(el.e_sin)) +
                         nu * nu * (std::fabs(el.i_sin) + std::fabs(el.i_cos));
    const double contact = a.radius + b.radius + allowance, far = contact + bound * half_square;
    const double d2 = d.squaredNorm(), dv = d.dot(v);
    if (d2 - 2.0 * up * std::fabs(dv) * longest > far * far * up) // a lower bound on |d + v t|²: most pairs end here
      return false;
    const double e2 = el.e_cos * el.e_cos + el.e_sin * el.e_sin, i2 = el.i_sin * el.i_sin + el.i_cos * el.i_cos;
    const double near = contact + up * std::sqrt(4.0 * kappa * kappa * e2 + nu * nu * nu * nu * i2) * half_square;
    return comes_near(d, v, dv, start, end, near);
  }

  /// As above, for the next `time` from `begin` on, with the tangents at `begin`. Precondition: time >= 0.
  bool may_touch_soon(const Body& a, const Body& b, double shift_x, double shift_y, const Rotation& begin,
                      double time) const {
    assert(!(time < 0.0));
    Elements el = b.elements - a.elements;
    el.guiding_x += shift_x;
    el.guiding_y += shift_y;
    const State s = state_at(el, frequencies, begin);
    const double acceleration =
        2.0 * frequencies.kappa * el.eccentricity() + frequencies.nu * frequencies.nu * el.inclination();
    const double near = a.radius + b.radius + allowance + 0.5 * up * acceleration * time * time;
    return comes_near(s.position, s.velocity, s.position.dot(s.velocity), 0.0, time, near);
  }

private:
  static constexpr double up = 1.0 + 1e-9; // for roundings

  // Returns true for values that are not finite.
  static bool comes_near(const Vec3& d, const Vec3& v, double dv, double first, double last, double near) {
    const double v2 = v.squaredNorm();
    const double closest = v2 > 0.0 ? std::clamp(-dv / v2, first, last) : first;
    return !((d + closest * v).squaredNorm() > near * near * up);
  }
};

} // namespace keeler::finders
