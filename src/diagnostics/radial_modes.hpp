// Radial waves that fit the box, k_n = 2πn/L_x: amplitude and phase of density and velocity, and their growth rate.
// They show overstability and axisymmetric density waves.
#pragma once

#include <keeler/diagnostics/analysis.hpp>
#include <keeler/particles/patch.hpp>

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace keeler::diagnostics {

/// Σ/⟨Σ⟩ − 1 is the real part of density × exp(i k x). The velocities are relative to the shear and the mean motion:
/// mass-weighted means, to first order in the amplitudes.
struct RadialMode {
  int n = 0;
  std::complex<double> density;
  std::complex<double> velocity_x, velocity_y; ///< m rad⁻¹

  /// Returns √(|v_x|² + |2Ω v_y/κ|²), m rad⁻¹: constant in an epicyclic oscillation while v_x and v_y alternate, for
  /// standing and travelling waves.
  double epicyclic_speed(double kappa) const;

  /// Return the epicyclic waves with crests that travel outward and inward: κ e exp(iφ) each, m rad⁻¹. The squares of
  /// their absolute values add up to half of the square of the epicyclic speed.
  std::complex<double> outward(double kappa) const;
  std::complex<double> inward(double kappa) const;
};

/// Returns modes 1 … count.
std::vector<RadialMode> radial_modes(const Patch& patch, int count);

/// Returns modes over the guiding radius X instead of x: the density of guiding centres, and the velocities of the
/// particles.
std::vector<RadialMode> guiding_modes(const Patch& patch, int count);

/// Returns the rms |density| of a mode of random particles: 2 √(Σm²)/Σm.
double radial_mode_noise(const Patch& patch);

/// Returns nothing unless there are two values at different times, and all are positive.
std::optional<Growth> growth(std::span<const double> times, std::span<const double> values);

std::vector<RadialModeAnalysis> analyze_radial_modes(std::span<const Patch> patches, int count);

} // namespace keeler::diagnostics
