#include "dispersion_relation.hpp"

#include <cassert>
#include <cmath>

namespace keeler::validation {

// The determinant of the three equations is s (s + a)(s + b) + P' k² (s + b) + κ² s + 2 S F' k², with a = (4ν/3 + ξ) k²
// and b = ν k². Its root by Newton's method, from the wave without viscosity.
std::complex<double> epicyclic_wave(const RingFluid& ring, const Frequencies& f, double k) {
  const double a = (4.0 / 3.0 * ring.viscosity + ring.bulk_viscosity) * k * k, b = ring.viscosity * k * k,
               pressure = ring.pressure_slope * k * k, kappa2 = f.kappa * f.kappa,
               flux = 2.0 * f.shear() * ring.flux_slope * k * k;
  std::complex<double> s(0.0, std::sqrt(kappa2 + pressure));
  for (int step = 0; step < 50; ++step)
    s -= (s * (s + a) * (s + b) + pressure * (s + b) + kappa2 * s + flux) /
         ((s + a) * (s + b) + s * (2.0 * s + a + b) + pressure + kappa2);
  assert(s.imag() > 0.0);
  return s;
}

// The determinant is linear in a and P' k².
RingFluid with_wave(const RingFluid& ring, const Frequencies& f, double k, std::complex<double> wave) {
  const double b = ring.viscosity * k * k, flux = 2.0 * f.shear() * ring.flux_slope * k * k;
  const std::complex<double> rest = -wave * wave - (f.kappa * f.kappa * wave + flux) / (wave + b); // a s + P' k²
  const double a = rest.imag() / wave.imag();
  RingFluid fluid = ring;
  fluid.bulk_viscosity = a / (k * k) - 4.0 / 3.0 * ring.viscosity;
  fluid.pressure_slope = (rest.real() - a * wave.real()) / (k * k);
  return fluid;
}

} // namespace keeler::validation
