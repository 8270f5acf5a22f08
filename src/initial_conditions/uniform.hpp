// A fresh, statistically uniform patch without overlaps: the default start of a run.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/initial_conditions/streamlines.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace keeler::initial_conditions {

/// A body with a given position and velocity, such as a moonlet.
struct HeldBody {
  Vec3 position, velocity;
  double radius, mass;

  void add_to(Patch& patch, std::uint64_t id) const;
};

/// A region in which no particle is placed.
struct ClosedBall {
  Vec3 centre;
  double radius;
};

/// Input of uniform_patch(), in internal units. In a distributed start each rank gives the radii of some particles,
/// with ids that follow the rank before; the root gives the held bodies; all ranks give all other values.
struct UniformRequest {
  ShearingBox box;
  Frequencies frequencies;
  std::vector<double> radii; ///< m, of particles first, first + 1, …; particle k gets id k
  std::uint64_t first = 0;
  double density = 900.0;                               ///< kg m⁻³
  std::function<double(std::uint64_t id)> density_of{}; ///< density of each particle, replaces `density` if set
  double dispersion_x = 1.0;                            ///< c_x, m rad⁻¹
  double dispersion_z = 0.65;                           ///< c_z, m rad⁻¹
  double own_room = 0.0;                                ///< m²: the layer's height is √(c_z²/ν² + own_room)
  Streamlines streamlines;                              ///< of the mean motion; circles by default
  std::vector<HeldBody> held;                           ///< their ids follow the particles' ids
  std::vector<ClosedBall> closed;                       ///< contain all held bodies; must not overlap
  scene::DensityPattern pattern;                        ///< of the guiding centres on the streamlines
  std::uint64_t seed = 1;
};

/// Returns a patch that is uniform in x and y (in X, if streamlines bunch), or follows the pattern. The profile in z is
/// Gaussian, or flat-topped with equal height if the mid-plane would exceed largest_filling (scene/derived.hpp).
/// Eccentricity vectors are Gaussian about the streamlines', so that c_y = c_x κ/2, and so are vertical
/// velocities. Their random parts and the heights have a mass-weighted mean of zero (of the particles alone if bodies
/// are held, apart from what these push aside). The gap of each pair is at least 2 × 10⁻⁵ of the smaller radius. Sizes
/// may differ by 10⁴ and more; time and memory are proportional to the number of particles. The result depends on the
/// request only, not on the number of threads and ranks; each rank gets some of the particles. Throws UsageError if
/// there is no room without overlap, Interrupted (interrupt.hpp). Collective: `progress` is called on all ranks at the
/// same points, and may throw if it throws on all.
Patch uniform_patch(const UniformRequest& request, const std::function<void(const StartProgress&)>& progress = {},
                    const Communicator& ranks = {});

} // namespace keeler::initial_conditions
