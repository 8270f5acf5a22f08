#include "velocity_ellipsoid.hpp"

#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/mean.hpp>

#include <algorithm>
#include <cmath>

namespace keeler::diagnostics {

VelocityMoments velocity_moments(const Patch& patch) {
  const Vec3 mean = mean_velocity(patch);
  const auto moment = [&](int a, int b) {
    return mass_mean(patch, [&](std::size_t k) {
      const Vec3 v = peculiar_velocity(patch, k) - mean;
      return v[a] * v[b];
    });
  };
  return {moment(0, 0), moment(0, 1), moment(1, 1), moment(2, 2)};
}

// The principal variances are m ± d, with m = (xx + yy)/2 and d = |((xx − yy)/2, xy)|.
VelocityEllipsoid velocity_ellipsoid(const VelocityMoments& v) {
  const double middle = 0.5 * (v.xx + v.yy), difference = std::hypot(0.5 * (v.xx - v.yy), v.xy);
  const double longer = middle + difference;
  if (!(longer > 0.0))
    return {};
  return {std::sqrt(std::max(0.0, middle - difference) / longer), std::sqrt(v.zz / longer),
          0.5 * std::atan2(v.xy, 0.5 * (v.xx - v.yy)) * 180.0 / pi};
}

} // namespace keeler::diagnostics
