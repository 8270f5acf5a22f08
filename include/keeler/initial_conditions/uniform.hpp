// A fresh, statistically uniform patch without overlaps: where a run starts when nothing else is given.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/initial_conditions/progress.hpp>
#include <keeler/initial_conditions/streamlines.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/density_pattern.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace keeler {

/// A body at a place of its own.
struct HeldBody {
  Vec3 place, velocity;
  double radius, mass;
};

/// Where no particle is placed.
struct ClosedBall {
  Vec3 centre;
  double radius;
};

/// What a uniform patch is made of. Internal units. Of several ranks each gives the radii of some particles, whose ids
/// follow those of the rank before, the first rank the held bodies, and all of them all else.
struct UniformRequest {
  ShearingBox box;
  Frequencies frequencies;
  std::vector<double> radii; ///< m, of particles first, first + 1, …; particle k gets id k
  std::uint64_t first = 0;
  double density = 900.0;                               ///< kg m⁻³
  std::function<double(std::uint64_t id)> density_of{}; ///< that of each in its place; empty: all have the same
  double dispersion_x = 1.0;                            ///< c_x, m rad⁻¹
  double dispersion_z = 0.65;                           ///< c_z, m rad⁻¹
  double own_room = 0.0;                                ///< m²: the layer's height is √(c_z²/ν² + own_room)
  Streamlines streamlines;                              ///< that the mean motion follows; circles unless given
  std::vector<HeldBody> held;                           ///< they come after the particles, with the ids that follow
  std::vector<ClosedBall> closed;                       ///< each held body is inside one of them; no two may overlap
  DensityPattern pattern;                               ///< of the guiding centres on them
  std::uint64_t seed = 1;
};

/// Uniform in x and y (in X, where streamlines bunch), or after the pattern; in z Gaussian, or flat-topped with the
/// same height where the mid-plane would be fuller than largest_filling (scene/derived.hpp). Eccentricity vectors are
/// Gaussian about those of the streamlines, so that c_y = c_x κ/2, and so are vertical velocities; their random parts
/// have no mean by mass, nor have the heights (of the particles alone where bodies are held, but for what these push
/// aside). Each pair is apart by at least 2 × 10⁻⁵ of the smaller radius. Sizes may differ by 10⁴ and more; time and
/// memory go with the number of particles. Same request, same state, for any number of threads and ranks, of which each
/// gets some of the particles. Throws UsageError when there is no room without overlap, Interrupted (interrupt.hpp).
/// Collective: `progress` is called on all ranks at the same points, and may throw where it throws on all.
Patch uniform_patch(const UniformRequest& request, const std::function<void(const StartProgress&)>& progress = {},
                    const Communicator& ranks = {});

} // namespace keeler
