// A fresh, statistically uniform patch without overlaps: where a run starts when nothing else is given.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/states/streamlines.hpp>

#include <cstdint>
#include <vector>

namespace keeler {

/// What a uniform patch is made of. Internal units.
struct UniformRequest {
  ShearingBox box;
  Frequencies frequencies;
  std::vector<double> radii;  ///< m, one a particle; particle k gets id k
  double density = 900.0;     ///< kg m⁻³
  double dispersion_x = 1.0;  ///< c_x, m rad⁻¹
  double dispersion_z = 0.65; ///< c_z, m rad⁻¹; the layer's height is c_z/ν
  Streamlines streamlines;    ///< that the mean motion follows; circles unless given
  std::uint64_t seed = 1;
};

/// Uniform in x and y (in X, where streamlines bunch), Gaussian in z, eccentricity and inclination vectors Gaussian
/// about those of the streamlines (so that c_y = c_x κ/2). Overlapping particles are pushed apart along their centre
/// lines until none is left; velocities stay. Same request, same state, for any number of threads. Throws UsageError
/// when the layer is too dense for that.
Patch uniform_patch(const UniformRequest& request);

} // namespace keeler
