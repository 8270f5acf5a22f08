// The light that comes along one ray: a random path of scatterings, followed from the observer backwards.
#pragma once

#include "tracer.hpp"

#include <keeler/light/scattering.hpp>

namespace keeler {
class RandomStream;
}

namespace keeler::light {

/// What a path adds to I/F.
struct PathLight {
  double single = 0.0;   ///< of light scattered once
  double multiple = 0.0; ///< of light scattered more often
  unsigned hits = 0;     ///< spheres met; 0: the ray passes
};

/// Follows a ray from `origin` along `direction`, away from the observer, with the Sun in the direction `sun`. Light of
/// any order is counted: a path ends where it leaves the layer, or by chance once its weight is small (Russian
/// roulette, which keeps the mean). Precondition: unit vectors.
PathLight follow_path(const Tracer& tracer, const ScatteringLaw& law, const Vec3& sun, const Vec3& origin,
                      const Vec3& direction, RandomStream& random);

} // namespace keeler::light
