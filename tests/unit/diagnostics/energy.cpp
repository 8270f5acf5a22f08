#include "energy.hpp"

#include <keeler/diagnostics/dispersion.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

namespace energy_test {

using namespace keeler;
using namespace keeler::diagnostics;

TEST_CASE("the random energy is that of the velocities beyond the shear, less that of the mean epicycle") {
  const Frequencies f{0.99458, 1.00539};
  Patch patch = test::uniform({60.0, 40.0, f.shear(), 0.0}, 7.0, 100, 1);
  patch.frequencies = f;
  RandomStream random(3, RandomPurpose::velocity, 0);
  double sum = 0.0, mass = 0.0;
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(); // weighted sums; velocities beyond the shear
  for (std::size_t k = 0; k < patch.size(); ++k) {
    patch.velocities[k] += Vec3(random.normal(), random.normal(), random.normal());
    patch.masses[k] = 1.0 + random.uniform();
    const Vec3 p = patch.positions[k], c = peculiar_velocity(patch, k);
    sum += patch.masses[k] * (0.5 * c.squaredNorm() + f.shear() / (f.kappa * f.kappa) * c.y() * c.y() +
                              0.5 * f.nu * f.nu * p.z() * p.z());
    mass += patch.masses[k];
    position += patch.masses[k] * p;
    velocity += patch.masses[k] * c;
  }
  const PatchEnergy energy = patch_energy(patch);
  position /= mass;
  velocity /= mass;
  const double of_mean = 0.5 * velocity.squaredNorm() + f.shear() / (f.kappa * f.kappa) * velocity.y() * velocity.y() +
                         0.5 * f.nu * f.nu * position.z() * position.z();
  CHECK(energy.horizontal + energy.vertical == doctest::Approx(sum / mass - of_mean).epsilon(1e-12));
  CHECK(energy.horizontal > 0.0);
  CHECK(energy.vertical > 0.0);
}

} // namespace energy_test
