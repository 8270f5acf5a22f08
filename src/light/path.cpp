#include "path.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/core/random.hpp>

namespace keeler::light {
namespace {

constexpr double small_weight = 0.1;

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
    const double lit = law.brightness(hit->normal, to, sun);
    if (lit > 0.0 && !tracer.blocked(tracer.leaving(*hit, sun), sun))
      (light.hits == 1 ? light.single : light.multiple) += weight * lit;
    const Scattering next = law.scatter(hit->normal, to, random);
    weight *= next.weight;
    if (weight < small_weight) {
      if (random.uniform() * small_weight >= weight)
        break;
      weight = small_weight;
    }
    along = next.from;
    from = tracer.leaving(*hit, along);
  }
  return light;
}

} // namespace keeler::light
