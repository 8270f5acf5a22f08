// How near a disc is to collapse under its own weight (Toomre 1964). G, Σ, κ and velocities in SI, or in any other
// units that go together.
#pragma once

#include <keeler/core/units.hpp>

namespace keeler {

/// λ_cr = 4π² G Σ / κ²: the longest wavelength at which gravity overcomes shear and rotation, and about the spacing of
/// self-gravity wakes.
inline double critical_wavelength(double newton_g, double surface_density, double kappa) {
  return 4.0 * pi * pi * newton_g * surface_density / (kappa * kappa);
}

/// Q = κ c_x / (3.36 G Σ) for a radial velocity dispersion c_x.
inline double toomre_q(double newton_g, double surface_density, double kappa, double dispersion) {
  return kappa * dispersion / (3.36 * newton_g * surface_density);
}

} // namespace keeler
