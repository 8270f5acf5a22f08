#include "aggregate.hpp"

#include "separation.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler {
namespace {

// Evenly in the unit ball.
Vec3 draw_in_ball(RandomStream random) {
  for (;;) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    if (const Vec3 place(2.0 * x - 1.0, 2.0 * y - 1.0, 2.0 * z - 1.0); place.squaredNorm() < 1.0)
      return place;
  }
}

} // namespace

std::vector<Vec3> pack_ball(std::span<const double> radii, double ball_radius, std::uint64_t seed,
                            std::uint64_t first) {
  constexpr int max_sweeps = 4000; // as full as can be some thousand are needed, at a filling of 0.5 a few hundred
  std::vector<Sphere> spheres;
  for (std::size_t k = 0; k < radii.size(); ++k) {
    const double room = ball_radius - radii[k];
    if (!(room > 0.0))
      return {};
    const Vec3 place = room * draw_in_ball(RandomStream(seed, RandomPurpose::aggregate, first + k));
    spheres.push_back({place, radii[k], 0.0, static_cast<std::uint32_t>(k)});
  }
  if (!separate_in_ball(spheres, ball_radius, max_sweeps))
    return {};
  std::vector<Vec3> places(spheres.size());
  for (const Sphere& sphere : spheres)
    places[sphere.particle] = sphere.place;
  return places;
}

std::vector<HeldBody> aggregate_bodies(const AggregateSettings& aggregate, std::size_t number, const Material& material,
                                       const Frequencies& frequencies, std::uint64_t seed) {
  const std::vector<Vec3> places = pack_ball(material.radii, aggregate.radius, seed, aggregate.first);
  if (places.empty())
    throw UsageError(fmt::format("particles.aggregate[{}]: {} cannot be packed at random to a filling of {} (the fewer "
                                 "they are, the less can be reached); lower its filling",
                                 number, pluralize(aggregate.count, "particle"), format_number(aggregate.filling, 4)));
  std::vector<HeldBody> bodies;
  Vec3 centre = Vec3::Zero();
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double radius = material.radii[k], mass = 4.0 / 3.0 * pi * material.densities[k] * radius * radius * radius;
    bodies.push_back({aggregate.position + places[k], Vec3::Zero(), radius, mass});
    centre += mass / aggregate.mass * bodies.back().place;
  }
  const double turning = aggregate.spin - 1.0; // in the rotating frame
  for (HeldBody& body : bodies) {
    const Vec3 arm = body.place - centre;
    body.velocity = Vec3(-turning * arm.y(), turning * arm.x() - frequencies.shear() * centre.x(), 0.0);
  }
  return bodies;
}

} // namespace keeler
