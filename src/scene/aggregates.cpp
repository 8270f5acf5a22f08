#include "aggregates.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

// Sets mass and radius of each ball by the radii that are drawn, so that balls and other particles cannot overlap.
void find_balls(std::vector<AggregateSettings>& aggregates, const ParticleSettings& particles) {
  if (aggregates.empty())
    return;
  assert(aggregates.back().first + aggregates.back().count == particles.count);
  const particles::DrawnSizes sizes(particles.sizes, particles.count, particles.seed);
  for (AggregateSettings& a : aggregates) {
    double cubes = 0.0;
    for (std::size_t k = a.first; k < a.first + a.count; ++k) {
      const double cube = std::pow(sizes.radius(k), 3);
      cubes += cube;
      a.mass += 4.0 / 3.0 * pi * (sizes.has_densities() ? sizes.density(k) : particles.density) * cube;
    }
    a.radius = std::cbrt(cubes / a.filling);
  }
}

} // namespace

std::vector<Key> aggregate_keys() {
  using enum KeyType;
  const auto own = [](Key key) {
    key.path = "particles.aggregate." + key.path;
    key.effect = KeyEffect::start;
    return key;
  };
  return {
      own({.path = "count",
           .type = integer,
           .example = "500",
           .unit = "1",
           .meaning = "number of particles that form a ball at the start, one ball per table [[particles.aggregate]]",
           .range = {.low = 1, .high = 1e9}}),
      own({.path = "filling_factor",
           .type = number,
           .fallback = "0.5",
           .unit = "1",
           .meaning = "filling factor of the ball, whose particles are packed at random",
           .range = {.low = 0, .high = 0.64, .low_open = true},
           .former_name = "filling"}),
      own({.path = "position",
           .type = triple,
           .fallback = "[0.0, 0.0, 0.0]",
           .unit = "m",
           .meaning = "centre of the ball: outward, along the orbit and up from the centre of the box",
           .range = {.low = -1e7, .high = 1e7},
           .former_name = "place"}),
      own({.path = "spin",
           .type = number,
           .fallback = "1.0",
           .unit = "Omega",
           .meaning = "its spin about the vertical against the stars; 1 keeps one face to the planet",
           .range = {.low = -100, .high = 100}}),
  };
}

std::vector<AggregateSettings> read_aggregates(config::Settings& settings, const std::string& name,
                                               const ParticleSettings& particles) {
  assert(particles.count > 0);
  std::vector<AggregateSettings> aggregates;
  std::size_t total = 0;
  for (const std::string& table : settings.tables("particles.aggregate")) {
    const Parameters p = settings.parameters(table, name);
    const auto count = static_cast<std::size_t>(p.integer("count"));
    if (count > particles.count - total)
      config::fail_at(
          settings.location(table + ".count"),
          fmt::format("{}.count = {} is too large (the scene has {}, of which {} are in earlier aggregates); "
                      "lower it or give the scene more particles",
                      table, count, pluralize(particles.count, "particle"), total));
    total += count;
    const std::vector<double> position = p.numbers("position");
    aggregates.push_back({.count = count,
                          .filling = p.number("filling_factor"),
                          .position = {position[0], position[1], position[2]},
                          .spin = p.number("spin")});
  }
  std::size_t first = particles.count - total;
  for (AggregateSettings& a : aggregates) {
    a.first = first;
    first += a.count;
  }
  find_balls(aggregates, particles);
  return aggregates;
}

} // namespace keeler::scene
