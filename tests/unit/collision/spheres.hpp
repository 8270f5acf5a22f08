// Patches placed by hand, sphere by sphere.
#pragma once

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/particles/patch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace keeler::test {

/// a / b in whole numbers: rows and layers of numbered spheres.
inline int quotient(int a, int b) {
  return a / b;
}

struct Sphere {
  Vec3 position;
  Vec3 velocity = Vec3::Zero(); ///< beyond the shear
  double radius = 1.0, mass = 1.0;
};

/// Sphere k gets id k.
inline Patch patch_of(const std::vector<Sphere>& spheres, double size_x, double size_y, const Frequencies& f = {}) {
  Patch patch;
  patch.frequencies = f;
  patch.box = {size_x, size_y, f.shear(), 0.0};
  for (const Sphere& s : spheres) {
    patch.ids.push_back(patch.ids.size());
    patch.positions.push_back(s.position);
    patch.velocities.push_back(s.velocity - Vec3(0.0, f.shear() * s.position.x(), 0.0));
    patch.radii.push_back(s.radius);
    patch.masses.push_back(s.mass);
  }
  return patch;
}

class RandomVectors {
public:
  explicit RandomVectors(std::uint64_t seed) : random_(seed, RandomPurpose::position, 0) {}
  double uniform() { return random_.uniform(); }
  Vec3 direction() {
    const double z = 2.0 * random_.uniform() - 1.0, rho = std::sqrt(1.0 - z * z), angle = two_pi * random_.uniform();
    return {rho * std::cos(angle), rho * std::sin(angle), z};
  }

private:
  RandomStream random_;
};

/// One large sphere of radius 1 and, within `thickness` of its surface, small ones of equal density with random
/// velocities; none overlap.
inline std::vector<Sphere> swarm(std::size_t count, double small, double thickness, double speed, std::uint64_t seed) {
  RandomVectors random(seed);
  std::vector<Sphere> spheres{{Vec3::Zero()}};
  while (spheres.size() <= count) {
    const double distance = 1.0 + small + thickness * (1e-6 + random.uniform());
    const Vec3 place = distance * random.direction();
    const bool free = std::none_of(spheres.begin(), spheres.end(), [&](const Sphere& s) {
      return (s.position - place).norm() < 1.0001 * (s.radius + small);
    });
    if (!free)
      continue;
    const double own_speed = speed * random.uniform();
    spheres.push_back({place, own_speed * random.direction(), small, small * small * small});
  }
  return spheres;
}

} // namespace keeler::test
