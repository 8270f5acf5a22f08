#include "aggregate.hpp"

#include "separation.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::initial_conditions {
namespace {

// Returns a uniform position in the unit ball.
Vec3 draw_in_ball(RandomStream random) {
  for (;;) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    if (const Vec3 position(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0); position.squaredNorm() < 1.0)
      return position;
  }
}

} // namespace

std::vector<Vec3> pack_ball(std::span<const double> radii, double ball_radius, std::uint64_t seed,
                            std::uint64_t first) {
  constexpr int max_sweeps = 4000; // a few hundred at a filling of 0.5, thousands near the limit
  std::vector<Sphere> spheres;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double room = ball_radius - radii[k];
    if (!(room > 0.0))
      return {};
    const Vec3 position = room * draw_in_ball(RandomStream(seed, RandomPurpose::aggregate, first + k));
    spheres.push_back({position, radii[k], 0.0, static_cast<std::uint32_t>(k)});
  }
  if (!separate_in_ball(spheres, ball_radius, max_sweeps))
    return {};
  std::vector<Vec3> positions(spheres.size());
  for (const Sphere& sphere : spheres)
    positions[sphere.particle] = sphere.position;
  return positions;
}

std::vector<HeldBody> aggregate_bodies(const scene::AggregateSettings& aggregate, std::size_t number,
                                       const Material& material, const Frequencies& frequencies, std::uint64_t seed) {
  assert(material.radii.size() == aggregate.count && material.densities.size() == aggregate.count);
  const std::vector<Vec3> positions = pack_ball(material.radii, aggregate.radius, seed, aggregate.first);
  if (positions.empty())
    throw UsageError(fmt::format("particles.aggregate[{}]: {} cannot be packed at random to a filling of {} (fewer "
                                 "particles reach only a lower filling); lower its filling",
                                 number, pluralize(aggregate.count, "particle"), format_number(aggregate.filling, 4)));
  std::vector<HeldBody> bodies;
  Vec3 centre = Vec3::Zero();
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double radius = material.radii[k], mass = 4.0 / 3.0 * pi * material.densities[k] * radius * radius * radius;
    bodies.push_back({aggregate.position + positions[k], Vec3::Zero(), radius, mass});
    centre += mass / aggregate.mass * bodies.back().position;
  }
  const double rotation = aggregate.spin - 1.0; // in the rotating frame
  for (HeldBody& body : bodies) {
    const Vec3 arm = body.position - centre;
    body.velocity = Vec3(-rotation * arm.y(), rotation * arm.x() - frequencies.shear() * centre.x(), 0.0);
  }
  return bodies;
}

} // namespace keeler::initial_conditions
