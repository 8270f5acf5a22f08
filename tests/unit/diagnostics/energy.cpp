#include "energy.hpp"

#include <keeler/diagnostics/dispersion.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

namespace energy_test {

using namespace keeler;
using namespace keeler::diagnostics;

TEST_CASE("the epicyclic energy is that of the velocities beyond the shear") {
  const Frequencies f{0.99458, 1.00539};
  Patch patch = test::uniform({60.0, 40.0, f.shear(), 0.0}, 7.0, 100, 1);
  patch.frequencies = f;
  RandomStream random(3, RandomPurpose::velocity, 0);
  double sum = 0.0, mass = 0.0;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    patch.velocities[k] += Vec3(random.normal(), random.normal(), random.normal());
    patch.masses[k] = 1.0 + random.uniform();
    const Vec3 p = patch.positions[k], c = peculiar_velocity(patch, k);
    sum += patch.masses[k] * (0.5 * c.squaredNorm() + f.shear() / (f.kappa * f.kappa) * c.y() * c.y() +
                              0.5 * f.nu * f.nu * p.z() * p.z());
    mass += patch.masses[k];
  }
  const PatchEnergy energy = patch_energy(patch);
  CHECK(energy.horizontal + energy.vertical == doctest::Approx(sum / mass).epsilon(1e-12));
  CHECK(energy.horizontal > 0.0);
  CHECK(energy.vertical > 0.0);
}

} // namespace energy_test
