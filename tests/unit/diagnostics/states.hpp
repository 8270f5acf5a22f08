// Made-up patches for the tests of diagnostics and pictures.
#pragma once

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/particles/patch.hpp>

#include <cmath>
#include <functional>

namespace keeler::test {

/// Equal spheres of 1 m at random places, kept with probability keep(x, y), at rest in the shear flow, z within ±1 m.
inline Patch scattered(const ShearingBox& box, double offset, std::size_t count, std::uint64_t seed,
                       const std::function<double(double, double)>& keep) {
  Patch patch;
  patch.box = box;
  patch.offset = offset;
  patch.orbital_frequency = 1.3175e-4;
  patch.frequencies.kappa = std::sqrt(4.0 - 2.0 * box.shear);
  RandomStream random(seed, RandomPurpose::position, 0);
  while (patch.size() < count) {
    const double x = (random.uniform() - 0.5) * box.size_x, y = (random.uniform() - 0.5) * box.size_y;
    const double z = 2.0 * random.uniform() - 1.0;
    if (random.uniform() > keep(x, y))
      continue;
    patch.ids.push_back(patch.size());
    patch.positions.emplace_back(x, y, z);
    patch.velocities.emplace_back(0.0, -box.shear * x, 0.0);
    patch.radii.push_back(1.0);
    patch.masses.push_back(4.0 / 3.0 * pi * 600.0);
  }
  return patch;
}

inline Patch uniform(const ShearingBox& box, double offset, std::size_t count, std::uint64_t seed) {
  return scattered(box, offset, count, seed, [](double, double) { return 1.0; });
}

/// A density wave that fits the sheared-periodic box: `across` wavelengths in x and `along` in y, the latter counted
/// positive for trailing crests.
struct Wave {
  double radial_length, pitch; // m along x; rad from the y axis

  Wave(const ShearingBox& box, double offset, int across, int along)
      : radial_length(box.size_x / (across + along * offset / box.size_y)),
        pitch(std::atan(along * radial_length / box.size_y)) {}

  double operator()(double x, double y) const {
    return 0.5 + 0.4 * std::cos(two_pi * (x + y * std::tan(pitch)) / radial_length);
  }
};

} // namespace keeler::test
