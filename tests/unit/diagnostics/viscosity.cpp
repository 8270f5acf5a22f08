#include <keeler/diagnostics/viscosity.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

namespace viscosity_test {

using namespace keeler;
using namespace keeler::diagnostics;

TEST_CASE("translational viscosity is the flux of correlated velocities over the shear") {
  const ShearingBox box{60.0, 40.0, 1.5, 0.0};
  Patch patch = test::uniform(box, 7.0, 400, 1);
  for (std::size_t k = 0; k < patch.size(); ++k) { // u_x = ±2, u_y = ±0.5 + ±1: ⟨u_x u_y⟩ = 1
    const double a = k % 2 == 0 ? 1.0 : -1.0, b = k % 4 < 2 ? 1.0 : -1.0;
    patch.velocities[k] += Vec3(2.0 * a, 0.5 * a + b, b) + Vec3(5.0, 3.0, 0.0); // the common motion carries nothing
  }
  CHECK(translational_viscosity(patch) == doctest::Approx(1.0 / 1.5).epsilon(1e-12));
}

TEST_CASE("epicycles of random phase carry no momentum") {
  const Frequencies f{0.99458, 1.0};
  Particles particles;
  for (int k = 0; k < 360; ++k) {
    const double phase = two_pi * k / 360;
    particles.bodies.push_back({{0.0, 0.0, 2.0 * std::cos(phase), 2.0 * std::sin(phase), 0.0, 0.0}, 1.0, 1.0});
    particles.ids.push_back(static_cast<std::uint64_t>(k));
  }
  const Patch patch = make_patch(particles, {60.0, 40.0, f.shear(), 0.0}, 7.0, f, 0.0);
  CHECK(std::fabs(translational_viscosity(patch)) < 1e-13);
}

} // namespace viscosity_test
