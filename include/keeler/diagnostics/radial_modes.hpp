// Waves along the radius that fit the box, k_n = 2πn/L_x: amplitude and phase of density and velocity, and how fast
// they grow. Overstability and axisymmetric density waves show in them.
#pragma once

#include <keeler/particles/patch.hpp>

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace keeler {

/// Σ/⟨Σ⟩ − 1 is the real part of density × exp(i k x), and likewise the velocities beyond the shear and the mean
/// motion: means of the velocity with the weight of the mass, to first order in the amplitudes.
struct RadialMode {
  int n = 0;
  std::complex<double> density;
  std::complex<double> velocity_x, velocity_y; ///< m rad⁻¹

  /// √(|v_x|² + |2Ω v_y/κ|²), m rad⁻¹: of an epicyclic oscillation it stays the same while v_x and v_y change places,
  /// in standing and in travelling waves.
  double epicyclic_speed(double kappa) const;

  /// The epicyclic waves whose crests travel outward and inward: κ e exp(iφ) each, m rad⁻¹. The squares of their
  /// absolute values add up to half of the square of the epicyclic speed.
  std::complex<double> outward(double kappa) const;
  std::complex<double> inward(double kappa) const;
};

/// Modes 1 … count.
std::vector<RadialMode> radial_modes(const Patch& patch, int count);

/// Returns the same over the guiding radius X instead of x: the density is that of guiding centres, the velocities are
/// still those at the particles.
std::vector<RadialMode> guiding_modes(const Patch& patch, int count);

/// rms |density| of a mode when particles stand at random: 2 √(Σm²)/Σm.
double radial_mode_noise(const Patch& patch);

/// Slope of a straight line fitted to ln(value) over time by least squares.
struct Growth {
  double rate = 0.0; ///< per unit of time
  /// Standard error by the scatter about the line, with neighbours as independent as they are
  /// (statistical_inefficiency() in time_series.hpp; at equal intervals); none of fewer than three values.
  std::optional<double> error;
};

/// None unless there are two values above 0 at different times, and none of them is 0 or less.
std::optional<Growth> growth(std::span<const double> times, std::span<const double> values);

/// Of several snapshots.
struct RadialModeAnalysis {
  int n = 0;
  double wavelength = 0.0;            ///< m
  double density_amplitude = 0.0;     ///< mean of |density|
  double density_phase_degrees = 0.0; ///< in the last snapshot: a crest stands at x = −phase/k
  double speed = 0.0;                 ///< mean epicyclic speed, m/s
  std::optional<Growth> growth;       ///< of the epicyclic speed, in Ω
};

std::vector<RadialModeAnalysis> analyze_radial_modes(std::span<const Patch> patches, int count);

} // namespace keeler
