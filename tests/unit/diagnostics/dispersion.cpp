#include <keeler/diagnostics/dispersion.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

namespace dispersion_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {
const ShearingBox box{60.0, 40.0, Frequencies{0.99458, 1.00539}.shear(), 0.0};
}

TEST_CASE("particles at rest in the shear flow have no dispersion, wherever they stand") {
  Patch patch = test::uniform(box, 7.0, 50, 1);
  CHECK(velocity_dispersion(patch).norm() < 1e-14);
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.velocities[k] += Vec3(0.2, -0.1, 0.3); // a common motion is not dispersion
  CHECK(velocity_dispersion(patch).norm() < 1e-14);
  CHECK((mean_velocity(patch) - Vec3(0.2, -0.1, 0.3)).norm() < 1e-14);
}

TEST_CASE("dispersion counts mass, and an image moves as its particle") {
  Patch patch = test::uniform(box, 7.0, 3, 1);
  const double speeds[] = {3.0, -1.0, 2.0};
  const double masses[] = {1.0, 2.0, 5.0};
  for (std::size_t k = 0; k < 3; ++k) {
    patch.velocities[k] += Vec3(speeds[k], 2.0 * speeds[k], -speeds[k]);
    patch.masses[k] = masses[k];
  }
  const double mean = (3.0 - 2.0 + 10.0) / 8.0;
  const double variance = (9.0 + 2.0 + 20.0) / 8.0 - mean * mean;
  const Vec3 expected = Vec3(1.0, 2.0, 1.0) * std::sqrt(variance);
  CHECK((velocity_dispersion(patch) - expected).norm() < 1e-13);

  const Image image{1, -1};
  patch.positions[1] += box.displacement(image, patch.offset);
  patch.velocities[1].y() -= box.shear * box.size_x;
  CHECK((velocity_dispersion(patch) - expected).norm() < 1e-12);
}

TEST_CASE("an ensemble of epicycles has c_x = κ e/√2, c_y = κ² e/(2√2), c_z = ν i/√2") {
  const Frequencies f{0.99458, 1.00539};
  Particles particles;
  const int count = 360; // evenly spread phases make the means exact
  for (int k = 0; k < count; ++k) {
    const double phase = two_pi * k / count;
    const Elements el{0.1 * (k % 7),         0.2 * (k % 11),        2.0 * std::cos(phase),
                      2.0 * std::sin(phase), 1.5 * std::sin(phase), 1.5 * std::cos(phase)};
    particles.bodies.push_back({el, 0.5, 3.0});
    particles.ids.push_back(static_cast<std::uint64_t>(k));
  }
  Patch patch = make_patch(particles, box, 7.0, f, 0.0);
  patch.orbital_frequency = 2e-4;
  // The speed along y relative to the shear at the particle is (2 − S) e cos φ = ½ κ² e cos φ.
  const Vec3 expected(f.kappa * 2.0, 0.5 * f.kappa * f.kappa * 2.0, f.nu * 1.5);
  const Vec3 measured = velocity_dispersion(patch);
  CHECK((measured - expected / std::sqrt(2.0)).norm() < 1e-12);
  CHECK(scale_height(patch) == doctest::Approx(1.5 / std::sqrt(2.0)).epsilon(1e-12));
  CHECK(mean_eccentricity(patch) == doctest::Approx(2.0).epsilon(1e-12));
  CHECK(mean_inclination(patch) == doctest::Approx(1.5).epsilon(1e-12));
  CHECK((velocity_si(patch, measured) - 2e-4 * measured).norm() < 1e-18);
  CHECK((velocity_in_radii(patch, measured) - 2.0 * measured).norm() < 1e-14);
}

} // namespace dispersion_test
