#include "placed_bodies.hpp"

#include <keeler/core/format.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

struct PlacedBody {
  std::string table;
  std::string size_key; // the key that sets its size
  Vec3 position;
  double radius;
  double height; // largest distance from the mid-plane, m
};

std::vector<PlacedBody> placed_bodies(const Scene& scene) {
  std::vector<PlacedBody> bodies;
  for (const AggregateSettings& a : scene.particles.aggregates)
    bodies.push_back({fmt::format("particles.aggregate[{}]", bodies.size() + 1), "count", a.position, a.radius,
                      std::fabs(a.position.z())});
  const std::size_t before_moonlets = bodies.size();
  const double vertical = scene.planet.frequencies.nu * scene.planet.orbital_frequency; // rad/s
  assert(vertical > 0.0);
  for (const MoonletSettings& m : scene.moonlets)
    bodies.push_back({fmt::format("moonlet[{}]", bodies.size() - before_moonlets + 1), "radius", m.position, m.radius,
                      std::hypot(m.position.z(), m.velocity.z() / vertical)});
  return bodies;
}

// Returns the distance of the nearest images.
double distance(const Vec3& a, const Vec3& b, const Scene& scene) {
  assert(scene.size_x > 0.0 && scene.size_y > 0.0);
  Vec3 d = a - b;
  d.x() -= scene.size_x * std::round(d.x() / scene.size_x);
  d.y() -= scene.size_y * std::round(d.y() / scene.size_y);
  return d.norm();
}

void check_in_box(const PlacedBody& body, const Scene& scene, const config::Settings& settings) {
  const std::string size = body.table + "." + body.size_key, key = body.table + ".position";
  if (!(2.0 * body.radius <= std::min(scene.size_x, scene.size_y)))
    config::fail_at(
        settings.location(size),
        fmt::format("{} is {} m across (more than one side of the box of {} m x {} m); enlarge the box or lower "
                    "the {}",
                    body.table, format_number(2.0 * body.radius, 4), format_number(scene.size_x, 4),
                    format_number(scene.size_y, 4), body.size_key));
  if (!(2.0 * std::fabs(body.position.x()) <= scene.size_x && 2.0 * std::fabs(body.position.y()) <= scene.size_y))
    config::fail_at(settings.location(key),
                    fmt::format("{} is outside the box (it extends {} m and {} m to each side of its centre); move it",
                                key, format_number(0.5 * scene.size_x, 4), format_number(0.5 * scene.size_y, 4)));
  if (const double longer = std::max(scene.size_x, scene.size_y); !(body.height <= longer))
    config::fail_at(
        settings.location(body.table),
        fmt::format("{} reaches {} m from the mid-plane (more than the longer side of the box, {} m: too far for a "
                    "ring); lower its position and its vertical velocity",
                    body.table, format_number(body.height, 4), format_number(longer, 4)));
}

} // namespace

void check_placed_bodies(const Scene& scene, const config::Settings& settings) {
  const std::vector<PlacedBody> bodies = placed_bodies(scene);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const PlacedBody& body = bodies[k];
    check_in_box(body, scene, settings);
    for (std::size_t j = 0; j < k; ++j)
      if (const double apart = distance(body.position, bodies[j].position, scene);
          apart < body.radius + bodies[j].radius)
        config::fail_at(
            settings.location(body.table),
            fmt::format("{} and {} overlap (their centres are {} m apart, their radii {} m and {} m); move one",
                        bodies[j].table, body.table, format_number(apart, 4), format_number(bodies[j].radius, 4),
                        format_number(body.radius, 4)));
  }
}

} // namespace keeler::scene
