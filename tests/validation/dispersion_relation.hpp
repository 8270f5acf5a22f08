// Axisymmetric waves in a ring that is a viscous fluid without self-gravity (Schmit & Tscharnuter 1995, Icarus 115,
// 304; Schmidt, Salo, Spahn & Petzschmann 2001, Icarus 153, 316). For perturbations that go as exp(ikx + st), with the
// surface density Σ(1 + σ), the velocities u along the radius and v along the orbit relative to the shear, and Ω = 1:
//
//   s σ = -ik u
//   s u = 2 v - ik P' σ - (4ν/3 + ξ) k² u
//   s v = -κ²/2 u - ik S F' σ - ν k² v
//
// with the shear rate S, P' = dP/dΣ, F' = d(νΣ)/dΣ and the bulk viscosity ξ. The outward wave has Im s < 0, and the
// inward one the conjugate.
#pragma once

#include <keeler/hill/elements.hpp>

#include <complex>

namespace keeler::validation {

/// What a ring is as a fluid; Ω = 1.
struct RingFluid {
  double viscosity = 0.0;      ///< ν, m²
  double flux_slope = 0.0;     ///< d(νΣ)/dΣ, m²
  double pressure_slope = 0.0; ///< dP/dΣ, m²
  double bulk_viscosity = 0.0; ///< ξ, m²
};

/// Returns growth rate and frequency (the imaginary part, above 0) of the epicyclic waves with the wavenumber k, 1/m.
std::complex<double> epicyclic_wave(const RingFluid& ring, const Frequencies& f, double k);

/// Returns the fluid with the slope of the pressure and the bulk viscosity for which that wave has this growth rate and
/// frequency; viscosity and flux_slope are kept.
RingFluid with_wave(const RingFluid& ring, const Frequencies& f, double k, std::complex<double> wave);

} // namespace keeler::validation
