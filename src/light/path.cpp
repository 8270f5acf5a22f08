#include "path.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/core/random.hpp>

#include <Eigen/Geometry>

namespace keeler::light {
namespace {

constexpr double small_weight = 0.1;

// Returns the point at which light leaves a particle in the direction `to` that came to it from `from`: the point of
// the hit, turned with the sphere by the rotation that takes `to` to `from`. What an observer sees at a place of the
// disc thus comes from the same place of the disc that the source sees. So the light leaves on the side that faces it,
// the path in the other direction has the same points, and at phase 0 it is the point itself.
Hit turned(const Hit& hit, const Vec3& to, const Vec3& from) {
  const double cosine = to.dot(from);
  const Vec3 axis = to.cross(from);
  Hit there = hit;
  if (cosine > -1.0 + 1e-12)
    there.normal = cosine * hit.normal + axis.cross(hit.normal) + axis.dot(hit.normal) / (1.0 + cosine) * axis;
  else // half a turn about any axis across
    there.normal = hit.normal - 2.0 * to.dot(hit.normal) * to;
  there.normal.normalize();
  there.point = hit.point + hit.radius * (there.normal - hit.normal);
  return there;
}

} // namespace

PathLight follow_path(const Tracer& tracer, const ScatteringLaw& law, const Vec3& sun, const Vec3& origin,
                      const Vec3& direction, RandomStream& random) {
  PathLight light;
  Vec3 from = origin, along = direction;
  double weight = 1.0;
  while (!interrupted()) {
    const std::optional<Hit> hit = tracer.first_hit(from, along);
    if (!hit)
      break;
    ++light.hits;
    const Vec3 to = -along;
    const auto begin = [&](const Vec3& source) {
      return tracer.leaving(law.of_particle() ? turned(*hit, to, source) : *hit);
    };
    const double lit = law.brightness(hit->normal, to, sun);
    if (lit > 0.0 && !tracer.blocked(begin(sun), sun))
      (light.hits == 1 ? light.single : light.multiple) += weight * lit;
    const Scattering next = law.scatter(hit->normal, to, random);
    weight *= next.weight;
    if (weight < small_weight) {
      if (random.uniform() * small_weight >= weight)
        break;
      weight = small_weight;
    }
    along = next.from;
    from = begin(along);
  }
  return light;
}

} // namespace keeler::light
