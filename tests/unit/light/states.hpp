// Made-up layers of spheres.
#pragma once

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/particles/patch.hpp>

#include <cmath>

namespace keeler::test {

/// Spheres of 1 m at random, which may overlap, of optical depth about `tau` and filling factor `filling` throughout.
inline Patch random_layer(double tau, double filling, std::size_t count, std::uint64_t seed, double offset = 0.0) {
  Patch patch;
  const double side = std::sqrt(static_cast<double>(count) * pi / tau), height = 4.0 / 3.0 * tau / filling;
  patch.box = {side, side, 1.5, 0.0};
  patch.offset = offset * side;
  patch.orbital_frequency = 1.3e-4;
  RandomStream random(seed, RandomPurpose::position, 0);
  for (std::size_t k = 0; k < count; ++k) {
    patch.positions.emplace_back((random.uniform() - 0.5) * side, (random.uniform() - 0.5) * side,
                                 (random.uniform() - 0.5) * height);
    patch.velocities.emplace_back(0.0, 0.0, 0.0);
    patch.radii.push_back(1.0);
    patch.masses.push_back(4000.0);
    patch.ids.push_back(k);
  }
  return patch;
}

/// Spheres of 0.4 to 1 m that do not overlap, also not with images, placed one after the other at random.
inline Patch dense_layer(double side_x, double side_y, double height, std::size_t count, std::uint64_t seed,
                         double offset) {
  Patch patch;
  patch.box = {side_x, side_y, 1.5, 0.0};
  patch.offset = offset;
  patch.orbital_frequency = 1.3e-4;
  RandomStream random(seed, RandomPurpose::position, 0);
  for (int tries = 0; tries < 2000000 && patch.size() < count; ++tries) {
    const Vec3 p((random.uniform() - 0.5) * side_x, (random.uniform() - 0.5) * side_y,
                 (random.uniform() - 0.5) * height);
    const double radius = 0.4 + 0.6 * random.uniform();
    bool free = true;
    for (std::size_t k = 0; k < patch.size() && free; ++k)
      for (int nx = -1; nx <= 1 && free; ++nx)
        for (int ny = -2; ny <= 2 && free; ++ny)
          free = (patch.positions[k] + patch.box.displacement({nx, ny}, offset) - p).norm() > radius + patch.radii[k];
    if (!free)
      continue;
    patch.positions.push_back(p);
    patch.velocities.emplace_back(0.0, 0.0, 0.0);
    patch.radii.push_back(radius);
    patch.masses.push_back(4000.0);
    patch.ids.push_back(patch.size());
  }
  return patch;
}

} // namespace keeler::test
