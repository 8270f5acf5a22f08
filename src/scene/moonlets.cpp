#include "moonlets.hpp"

#include "key_table.hpp"

#include <keeler/core/units.hpp>
#include <keeler/core/words.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

Vec3 vector_of(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

std::string table_of(std::size_t k) {
  return fmt::format("moonlet[{}]", k + 1);
}

// Distance of the nearest images.
double distance(const Vec3& a, const Vec3& b, const Scene& scene) {
  Vec3 d = a - b;
  d.x() -= scene.size_x * std::round(d.x() / scene.size_x);
  d.y() -= scene.size_y * std::round(d.y() / scene.size_y);
  return d.norm();
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
           .meaning = "radius of a body beside the particles, one in each table [[moonlet]]",
           .range = {.low = 1e-6, .high = 1e6}}),
      own({.path = "density",
           .type = number,
           .example = "900.0",
           .unit = "kg/m^3",
           .meaning = "density of its material",
           .range = material_densities,
           .alternatives = {"moonlet.mass"}}),
      own({.path = "mass",
           .type = number,
           .example = "1e8",
           .unit = "kg",
           .meaning = "its mass",
           .range = KeyRange::above(0),
           .alternatives = {"moonlet.density"}}),
      own({.path = "place",
           .type = triple,
           .fallback = "[0.0, 0.0, 0.0]",
           .unit = "m",
           .meaning = "where it is at the start: outward, along the orbit and up from the middle of the box"}),
      own({.path = "velocity",
           .type = triple,
           .fallback = "[0.0, 0.0, 0.0]",
           .unit = "m/s",
           .meaning = "its velocity at the start beyond that of a circular orbit at its place",
           .range = {.low = -1000, .high = 1000}}),
  };
}

std::vector<MoonletSettings> read_moonlets(Settings& settings, const std::string& name) {
  std::vector<MoonletSettings> moonlets;
  for (const std::string& table : settings.tables("moonlet")) {
    const Parameters p = settings.parameters(table, name);
    const double radius = p.number("radius"), volume = 4.0 / 3.0 * pi * radius * radius * radius;
    const double mass = p.has("mass") ? p.number("mass") : p.number("density") * volume, density = mass / volume;
    if (p.has("mass") && !material_densities.contains(density))
      fail_at(settings.place(table + ".mass"),
              fmt::format("{}.mass makes a density of {} kg/m^3, but it must be {}; change the mass or the radius",
                          table, figures(density, 3), material_densities.words()));
    moonlets.push_back({radius, mass, vector_of(p.numbers("place")), vector_of(p.numbers("velocity"))});
  }
  return moonlets;
}

void check_moonlets(const Scene& scene, const Settings& settings) {
  const std::vector<MoonletSettings>& moonlets = scene.moonlets;
  for (std::size_t k = 0; k < moonlets.size(); ++k) {
    const MoonletSettings& m = moonlets[k];
    const std::string table = table_of(k);
    if (!(2.0 * m.radius <= std::min(scene.size_x, scene.size_y)))
      fail_at(settings.place(table + ".radius"),
              fmt::format("{} is {} m across (more than a side of the box of {} m x {} m); enlarge the box or lower "
                          "the radius",
                          table, figures(2.0 * m.radius, 4), figures(scene.size_x, 4), figures(scene.size_y, 4)));
    if (!(2.0 * std::fabs(m.place.x()) <= scene.size_x && 2.0 * std::fabs(m.place.y()) <= scene.size_y))
      fail_at(settings.place(table + ".place"),
              fmt::format("{}.place is outside the box (it reaches {} m and {} m to each side of its middle); move it",
                          table, figures(0.5 * scene.size_x, 4), figures(0.5 * scene.size_y, 4)));
    for (std::size_t j = 0; j < k; ++j)
      if (const double apart = distance(m.place, moonlets[j].place, scene); apart < m.radius + moonlets[j].radius)
        fail_at(settings.place(table),
                fmt::format("{} and {} overlap (their centres are {} m apart, their radii {} m and {} m); move one",
                            table_of(j), table, figures(apart, 4), figures(moonlets[j].radius, 4),
                            figures(m.radius, 4)));
  }
}

} // namespace keeler
