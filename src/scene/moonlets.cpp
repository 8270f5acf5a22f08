#include "moonlets.hpp"

#include "material.hpp"

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::scene {
namespace {

Vec3 vector_of(const std::vector<double>& numbers) {
  assert(numbers.size() == 3);
  return {numbers[0], numbers[1], numbers[2]};
}

} // namespace

std::vector<Key> moonlet_keys() {
  using enum KeyType;
  const auto own = [](Key key) {
    key.path = "moonlet." + key.path;
    key.effect = KeyEffect::start;
    return key;
  };
  return {
      own({.path = "radius",
           .type = number,
           .example = "30.0",
           .unit = "m",
           .meaning = "radius of a body among the particles, one per table [[moonlet]]",
           .range = {.low = 1e-6, .high = 1e6}}),
      own({.path = "density",
           .type = number,
           .example = "900.0",
           .unit = "kg/m^3",
           .meaning = "density of the body's material",
           .range = material_densities,
           .alternatives = {"moonlet.mass"}}),
      own({.path = "mass",
           .type = number,
           .example = "1e8",
           .unit = "kg",
           .meaning = "mass of the body",
           .range = {.low = 1e-20, .high = 1e24}, // follows from the ranges of radius and density
           .alternatives = {"moonlet.density"}}),
      own({.path = "position",
           .type = triple,
           .fallback = "[0.0, 0.0, 0.0]",
           .unit = "m",
           .meaning = "position at the start: outward, along the orbit and up from the centre of the box",
           .range = {.low = -1e7, .high = 1e7},
           .former_name = "place"}),
      own({.path = "velocity",
           .type = triple,
           .fallback = "[0.0, 0.0, 0.0]",
           .unit = "m/s",
           .meaning = "velocity at the start relative to a circular orbit at this position",
           .range = {.low = -1000, .high = 1000}}),
  };
}

std::vector<MoonletSettings> read_moonlets(config::Settings& settings, const std::string& name) {
  std::vector<MoonletSettings> moonlets;
  for (const std::string& table : settings.tables("moonlet")) {
    const Parameters p = settings.parameters(table, name);
    const double radius = p.number("radius"), volume = 4.0 / 3.0 * pi * radius * radius * radius;
    const double mass = p.has("mass") ? p.number("mass") : p.number("density") * volume, density = mass / volume;
    if (p.has("mass") && !material_densities.contains(density))
      config::fail_at(
          settings.location(table + ".mass"),
          fmt::format("{}.mass gives a density of {} kg/m^3, but it must be {}; change the mass or the radius", table,
                      format_number(density, 3), material_densities.words()));
    moonlets.push_back({radius, mass, vector_of(p.numbers("position")), vector_of(p.numbers("velocity"))});
  }
  return moonlets;
}

} // namespace keeler::scene
