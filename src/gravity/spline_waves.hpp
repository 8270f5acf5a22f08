// Transforms of the cubic spline that spreads particles on nodes. Angles are wave numbers times the spacing.
#pragma once

#include <cmath>

namespace keeler::gravity {

/// Returns the transform of the spline, 1 at 0.
inline double spline_transform(double angle) {
  const double half = 0.5 * angle;
  const double ratio = angle == 0.0 ? 1.0 : std::sin(half) / half;
  return ratio * ratio * ratio * ratio;
}

/// Returns the sum of squared transforms over all aliases angle + 2π n: the transform of the spline of order 8 at the
/// nodes. The argument is the cosine of the angle.
inline double aliased_spline_squares(double cosine) {
  const double twice = 2.0 * cosine * cosine - 1.0, thrice = cosine * (2.0 * twice - 1.0);
  return (2416.0 + 2.0 * (1191.0 * cosine + 120.0 * twice + thrice)) / 5040.0;
}

} // namespace keeler::gravity
