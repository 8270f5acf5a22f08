#include <keeler/hill/toomre.hpp>

#include <doctest/doctest.h>

namespace toomre_test {

using namespace keeler;
using namespace keeler::hill;

TEST_CASE("Toomre's wavelength and Q have their published form in any units") {
  const double omega = 1.95e-4, sigma = 400.0, wavelength = critical_wavelength(newton_g_si, sigma, omega);
  CHECK(wavelength == doctest::Approx(39.478417604 * 6.6743e-11 * 400.0 / (1.95e-4 * 1.95e-4)).epsilon(1e-6));
  CHECK(critical_wavelength(newton_g(omega), sigma, 1.0) == doctest::Approx(wavelength).epsilon(1e-12));
  // c_x = 3.36 G Σ / κ is the speed at which Q is 1
  CHECK(toomre_q(newton_g_si, sigma, omega, 3.36 * 6.6743e-11 * 400.0 / omega) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(toomre_q(newton_g(omega), sigma, 1.0, 0.01) ==
        doctest::Approx(toomre_q(newton_g_si, sigma, omega, 0.01 * omega)).epsilon(1e-12));
}

} // namespace toomre_test
