// Stellar occultations: mean transmission, normal optical depth, and the statistics of the flicker as footprints of a
// given size cross the line of sight. Over one or several snapshots.
#pragma once

#include <keeler/diagnostics/transmission.hpp>
#include <keeler/statistics/measured.hpp>

#include <span>

namespace keeler::diagnostics {

/// Moments of the transmission of footprints about their mean, without photon noise.
struct FlickerMoments {
  double variance = 0.0;          ///< second central moment
  std::optional<double> skewness; ///< third central moment / variance^(3/2); empty without variance
  std::optional<double> kurtosis; ///< fourth central moment / variance² − 3: 0 for a normal distribution
};

/// Returns the moments of these transmissions. Precondition: at least one.
FlickerMoments flicker_moments(std::span<const double> transmissions);

/// What one line of sight shows.
struct Occultation {
  LineOfSight sight;                                ///< its angles
  statistics::Measured transmission;                ///< mean T of the snapshots, and the scatter of single ones
  double ray_error = 0.0;                           ///< standard error of the mean T, by the finite number of rays
  std::optional<double> normal_optical_depth;       ///< τ_n = −sin B ln T; empty if no light passes
  std::optional<double> normal_optical_depth_error; ///< from ray_error
  FlickerMoments flicker;                           ///< of the footprints of all snapshots
};

/// Returns the occultation by all patches together. Precondition: at least one patch, all with the box of the rays.
Occultation occultation(std::span<const Patch> patches, const RayLattice& rays, const LineOfSight& sight);

/// The dependence of T on azimuth at one elevation: (T_max − T_min)/(T_max + T_min), and the azimuth of T_max (rad).
/// Wakes transmit most light along their crests.
struct AzimuthalAsymmetry {
  double amplitude = 0.0;         ///< in [0, 1]
  double brightest_azimuth = 0.0; ///< rad
};

/// Returns the asymmetry of occultations at one elevation; nothing for fewer than two or if no light passes.
std::optional<AzimuthalAsymmetry> azimuthal_asymmetry(std::span<const Occultation> of_one_elevation);

} // namespace keeler::diagnostics
