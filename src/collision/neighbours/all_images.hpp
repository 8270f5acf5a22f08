// The search of last resort: all particles through all images that a step can bring into contact.
#pragma once

#include "reach.hpp"
#include "search_context.hpp"

#include <keeler/core/interrupt.hpp>

#include <cassert>
#include <cmath>

namespace keeler::collision {

/// Calls visit(j, image of j) for every other particle that i may touch from `start` (rad after the epoch) on. Throws
/// InvariantError if one of them may come from too far away (reach.hpp), and Interrupted.
template<class Visit>
void visit_all_images(const SearchContext& step, std::size_t i, double start, const Visit& visit) {
  assert(i < step.particles.size());
  const Body& body = step.particles.bodies[i];
  const auto across = [&](double distance, double size) {
    return static_cast<std::int32_t>(std::ceil(distance / size)) + 1;
  };
  const Frequencies& f = step.frequencies;
  for (std::size_t j = 0; j < step.particles.size(); ++j) {
    if (j == i)
      continue;
    const Body& other = step.particles.bodies[j];
    const Image nearest = step.nearest_image(body, other);
    const double e = body.elements.eccentricity() + other.elements.eccentricity();
    const double x = body.radius + other.radius + step.step * f.kappa * e;
    const double y = body.radius + other.radius + step.step * (f.shear() * (x + e) + 2.0 * e);
    throw_if_interrupted();
    require_reach(x, y, step.box);
    const std::int32_t far_x = across(x, step.box.size_x), far_y = across(y, step.box.size_y);
    for (std::int32_t nx = -far_x; nx <= far_x; ++nx)
      for (std::int32_t ny = -far_y - std::abs(nx); ny <= far_y + std::abs(nx); ++ny) {
        const Image image{nearest.nx + nx, nearest.ny + ny};
        if (step.may_touch(i, j, image, start))
          visit(j, image);
      }
  }
}

} // namespace keeler::collision
