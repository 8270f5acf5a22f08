#include <keeler/diagnostics/surface.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

namespace surface_test {

using namespace keeler;
using namespace keeler::diagnostics;

TEST_CASE("optical depth, surface density and λ_cr of the standard A-ring patch") {
  // τ = 0.5, r = 1 m, 600 kg/m³ give Σ = 400 kg/m² and, at Ω = 1.3175e-4 rad/s and κ = 0.99458 Ω, λ_cr = 61.4 m.
  const ShearingBox box{200.0, 100.0 * pi, Frequencies{0.99458, 1.00539}.shear(), 0.0};
  const Patch patch = test::uniform(box, 0.0, 10'000, 1);
  CHECK(optical_depth(patch) == doctest::Approx(0.5).epsilon(1e-12));
  CHECK(surface_density(patch) == doctest::Approx(400.0).epsilon(1e-12));
  const double kappa_si = 0.99458 * 1.3175e-4;
  CHECK(critical_wavelength(patch) ==
        doctest::Approx(4.0 * pi * pi * 6.67430e-11 * 400.0 / (kappa_si * kappa_si)).epsilon(1e-9));
  CHECK(critical_wavelength(patch) == doctest::Approx(61.4).epsilon(1e-3));
}

TEST_CASE("Q is 1 at the critical dispersion") {
  const ShearingBox box{200.0, 100.0 * pi, 1.5, 0.0};
  Patch patch = test::uniform(box, 0.0, 10'000, 1);
  const double critical_si = 3.36 * 6.67430e-11 * 400.0 / 1.3175e-4; // m/s, κ = Ω
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.velocities[k].x() += (k % 2 == 0 ? 1.0 : -1.0) * critical_si / 1.3175e-4;
  CHECK(toomre_q(patch) == doctest::Approx(1.0).epsilon(1e-9));
}

TEST_CASE("the mid-plane filling factor is the area of the circles that the plane cuts") {
  const ShearingBox box{10.0, 10.0, 1.5, 0.0};
  Patch patch = test::uniform(box, 0.0, 3, 1);
  patch.radii = {2.0, 2.0, 1.0};
  patch.positions[0].z() = 0.0;
  patch.positions[1].z() = -1.2; // a circle of radius 1.6
  patch.positions[2].z() = 1.5;  // above the plane
  CHECK(midplane_filling(patch) == doctest::Approx(pi * (4.0 + 2.56) / 100.0).epsilon(1e-12));
}

} // namespace surface_test
