// Directions about an axis.
#pragma once

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/core/vector.hpp>

#include <algorithm>
#include <cmath>

namespace keeler::light {

/// Returns a unit vector at the angle of this cosine from the axis, at a random angle around it. The axis has length 1.
inline Vec3 direction_about(const Vec3& axis, double cosine, RandomStream& random) {
  // Duff et al. (2017, J. Comput. Graph. Tech. 6, 1): two directions across the axis, without a branch at a pole
  const double sign = std::copysign(1.0, axis.z()), a = -1.0 / (sign + axis.z()), b = axis.x() * axis.y() * a;
  const Vec3 first(1.0 + sign * axis.x() * axis.x() * a, sign * b, -sign * axis.x());
  const Vec3 second(b, sign + axis.y() * axis.y() * a, -axis.y());
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), around = two_pi * random.uniform();
  return (cosine * axis + sine * std::cos(around) * first + sine * std::sin(around) * second).normalized();
}

} // namespace keeler::light
