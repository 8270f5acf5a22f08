#include <keeler/scene/planet.hpp>

#include <keeler/core/units.hpp>
#include <keeler/hill/toomre.hpp>

#include <cassert>
#include <cmath>

namespace keeler::scene {

double critical_wavelength(double surface_density, const PlanetSettings& planet) {
  return hill::critical_wavelength(newton_g_si, surface_density, planet.frequencies.kappa * planet.orbital_frequency);
}

double toomre_q(double surface_density, double dispersion, const PlanetSettings& planet) {
  return hill::toomre_q(newton_g_si, surface_density, planet.frequencies.kappa * planet.orbital_frequency, dispersion);
}

double distance_from_saturn(const PlanetSettings& planet) {
  constexpr double saturn_gm = 3.7931207e16; // m³ s⁻² (Jacobson et al. 2006)
  const double kappa = planet.frequencies.kappa, omega = planet.orbital_frequency;
  assert(omega > 0.0);
  return std::cbrt(2.0 * saturn_gm / (omega * omega * (1.0 + kappa * kappa)));
}

double hill_parameter(double density, double distance) {
  assert(density >= 0.0 && distance > 0.0);
  return 0.82 * std::cbrt(density / 900.0) * distance / 1e8;
}

} // namespace keeler::scene
