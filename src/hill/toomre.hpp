// Gravitational stability of a disc (Toomre 1964). G, Σ, κ and velocities are in SI or any consistent units.
#pragma once

#include <keeler/core/units.hpp>

namespace keeler::hill {

/// Returns λ_cr = 4π² G Σ / κ²: the longest wavelength at which gravity overcomes shear and rotation, and approximately
/// the spacing of self-gravity wakes.
inline double critical_wavelength(double newton_g, double surface_density, double kappa) {
  return 4.0 * pi * pi * newton_g * surface_density / (kappa * kappa);
}

/// Returns Q = κ c_x / (3.36 G Σ) for a radial velocity dispersion c_x.
inline double toomre_q(double newton_g, double surface_density, double kappa, double dispersion) {
  return kappa * dispersion / (3.36 * newton_g * surface_density);
}

} // namespace keeler::hill
