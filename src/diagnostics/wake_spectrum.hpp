// The size and the direction of self-gravity wakes from the power spectrum of the surface density,
//
//   P(k) = |Σ_j m_j exp(−i k·r_j)|² / (Σ_j m_j)² − Σ m²/(Σ m)²,
//
// at the waves k that fit the sheared box: k_y = 2πn_y/L_y, k_x = (2πn_x + k_y d)/L_x. The second term is the power of
// random particles (shot noise). All results are integrals over the spectrum of a smoothed density, so they are stable
// where a maximum of the autocorrelation jumps. They depend on the smoothing, which must be quoted with them.
//
// Spheres cannot overlap, so a dense layer is more even than random particles, and P is negative along weak wakes. The
// angle is not affected, since this effect is isotropic. The lengths exclude bins of similar length and direction with
// a negative mean over all snapshots.
#pragma once

#include <keeler/particles/patch.hpp>

#include <array>
#include <optional>

namespace keeler::diagnostics {

/// The density is smoothed by a Gaussian of this standard deviation, in λ_cr: power is weighted by exp(−(k λ_cr/8)²).
/// This removes clumps and contacts inside a wake, and leaves structures as wide as a wake or wider.
inline constexpr double wake_smoothing = 1.0 / 8.0;

/// Sums of filtered power over waves, each wave and its opposite counted once. Sums of several snapshots add up.
struct WakePower {
  /// Waves of similar length and direction.
  struct Bin {
    double power = 0.0;             ///< Σ P
    double k = 0.0, k_radial = 0.0; ///< Σ P |k|, Σ P |k_x|, m⁻¹
  };
  static constexpr std::size_t lengths = 16, directions = 12;

  std::array<Bin, lengths * directions> bins{};
  double power = 0.0;              ///< Σ P: half the variance of the smoothed Σ/⟨Σ⟩
  double cosine = 0.0, sine = 0.0; ///< Σ P cos 2θ, Σ P sin 2θ with tan θ = k_y/k_x
  double noise_squares = 0.0;      ///< variance of `power` for random particles
  int snapshots = 0;

  WakePower& operator+=(const WakePower& more);
};

/// Measures one snapshot. `critical_wavelength` (m) sets the smoothing. Returns all zeros, `snapshots` too, if λ_cr is
/// below four cells of the mesh that the autocorrelation uses.
WakePower wake_power(const Patch& patch, double critical_wavelength);

/// Results from the sums.
struct WakeWaves {
  double contrast = 0.0; ///< rms of the filtered Σ/⟨Σ⟩ − 1, noise subtracted; 0 below the noise

  // empty unless |Σ P exp(2iθ)| exceeds five times its noise: wakes have a direction
  std::optional<double> wavelength;        ///< λ_⊥ = 2π Σ P / Σ P |k| over bins where Σ P > 0, m
  std::optional<double> radial_wavelength; ///< λ_x = 2π Σ P / Σ P |k_x|, over these bins, m
  std::optional<double> angle_degrees;     ///< of the wakes from the y axis, (−90, 90], positive when trailing
};

WakeWaves wake_waves(const WakePower& sums);

} // namespace keeler::diagnostics
