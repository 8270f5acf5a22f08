// A fresh, statistically uniform patch without overlaps: where a run starts when nothing else is given.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/states/progress.hpp>
#include <keeler/states/streamlines.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace keeler {

/// What a uniform patch is made of. Internal units.
struct UniformRequest {
  ShearingBox box;
  Frequencies frequencies;
  std::vector<double> radii;  ///< m, one a particle; particle k gets id k
  double density = 900.0;     ///< kg m⁻³
  double dispersion_x = 1.0;  ///< c_x, m rad⁻¹
  double dispersion_z = 0.65; ///< c_z, m rad⁻¹
  double own_room = 0.0;      ///< m²: the layer's height is √(c_z²/ν² + own_room)
  Streamlines streamlines;    ///< that the mean motion follows; circles unless given
  std::uint64_t seed = 1;
};

/// Uniform in x and y (in X, where streamlines bunch); in z Gaussian, or flat-topped with the same height where the
/// mid-plane would be fuller than largest_filling (scene/derived.hpp). Eccentricity vectors are Gaussian about those of
/// the streamlines, so that c_y = c_x κ/2, and so are vertical velocities; their random parts have no mean by mass, nor
/// have the heights. Each pair is apart by at least 2 × 10⁻⁵ of the smaller radius. Sizes may differ by 10⁴ and more;
/// time and memory go with the number of particles. Same request, same state, for any number of threads.
/// Throws UsageError when there is no room without overlap, Interrupted (interrupt.hpp).
Patch uniform_patch(const UniformRequest& request, const std::function<void(const StartProgress&)>& progress = {});

} // namespace keeler
