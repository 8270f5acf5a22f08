// Small random patches for the tests of the drift phase, from a few numbers.
#pragma once

#include <keeler/collision/settings.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/uniform.hpp>
#include <keeler/particles/sizes.hpp>

#include <cmath>
#include <optional>

namespace keeler::test {

inline constexpr double omega = 1.3175e-4; ///< rad/s

struct Scenario {
  std::size_t count = 60;
  double optical_depth = 0.5, filling = 0.15;
  double smallest = 1.0; ///< radius; the largest is 1
  double kappa = 1.0, nu = 1.0;
  double step = two_pi * 1e-3;
  RestitutionLaw restitution = collision::constant_restitution(0.5);
  std::optional<collision::Friction> friction{};
};

inline collision::CollisionSettings settings_of(const Scenario& s) {
  collision::CollisionSettings settings;
  settings.restitution = s.restitution;
  settings.friction = s.friction;
  return settings;
}

/// A patch in a box of 1.44 : 1.
inline Patch make_patch(const Scenario& s, std::uint64_t seed) {
  initial_conditions::UniformRequest request;
  request.frequencies = {s.kappa, s.nu};
  const particles::SizeLaw law =
      s.smallest < 1.0 ? particles::power_sizes(3.0, s.smallest, 1.0) : particles::equal_sizes(1.0);
  request.radii = draw_radii(law, s.count, seed);
  double area = 0.0, volume = 0.0;
  for (const double r : request.radii) {
    area += pi * r * r / s.optical_depth;
    volume += 4.0 / 3.0 * pi * r * r * r;
  }
  request.box = {std::sqrt(area) * 1.2, std::sqrt(area) / 1.2, request.frequencies.shear(), 0.0};
  request.box.first_offset = 0.41 * request.box.size_y * static_cast<double>(seed % 3);
  request.dispersion_z = s.nu * volume / area / (std::sqrt(two_pi) * s.filling);
  request.dispersion_x = request.dispersion_z / (0.65 * s.nu);
  request.seed = seed;
  Patch patch = uniform_patch(request);
  if (s.friction) {
    RandomStream random(seed, RandomPurpose::velocity, s.count);
    for (std::size_t k = 0; k < s.count; ++k) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      patch.spins.push_back(4.0 * Vec3(x - 0.5, y - 0.5, z));
    }
  }
  return patch;
}

} // namespace keeler::test
