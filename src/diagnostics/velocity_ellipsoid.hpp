// The velocity ellipsoid: the covariance tensor of the peculiar velocities, its principal axes in the ring plane, and
// the angle from the radial direction to the longer one (vertex deviation).
#pragma once

#include <keeler/diagnostics/analysis.hpp>
#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Mass-weighted second moments about the mean velocity, m² rad⁻². Moments of several snapshots add up as means.
struct VelocityMoments {
  double xx = 0.0, xy = 0.0, yy = 0.0, zz = 0.0;
};

VelocityMoments velocity_moments(const Patch& patch);

/// For isotropic motion in the plane the ratio is 1 and the deviation meaningless.
VelocityEllipsoid velocity_ellipsoid(const VelocityMoments& moments);

} // namespace keeler::diagnostics
