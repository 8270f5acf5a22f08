// What a star behind the ring shows: mean transmission, normal optical depth, and the statistics of its flicker as
// footprints of a stated size cross the line of sight. Over one or several snapshots.
#pragma once

#include <keeler/diagnostics/transmission.hpp>
#include <keeler/statistics/measured.hpp>

#include <span>

namespace keeler {

/// Moments of the transmission of footprints about their mean. Photon noise is not in them.
struct FlickerMoments {
  double variance = 0.0;
  std::optional<double> skewness; ///< third central moment / variance^(3/2); none without variance
  std::optional<double> kurtosis; ///< fourth central moment / variance² − 3: 0 for a normal distribution
};

FlickerMoments flicker_moments(std::span<const double> transmissions);

struct Occultation {
  LineOfSight sight;
  Measured transmission;                            ///< mean T of the snapshots, and the scatter of single ones
  double ray_error = 0.0;                           ///< standard error of the mean T from the finite number of rays
  std::optional<double> normal_optical_depth;       ///< τ_n = −sin B ln T; none when nothing passes
  std::optional<double> normal_optical_depth_error; ///< from ray_error
  FlickerMoments flicker;                           ///< of the footprints of all snapshots
};

/// Patches of one box, at least one.
Occultation occultation(std::span<const Patch> patches, const RayLattice& rays, const LineOfSight& sight);

/// How much T depends on azimuth at one elevation: (T_max − T_min)/(T_max + T_min), and where T is largest (rad). Wakes
/// let most light pass along their crests. None unless two azimuths were looked at and some light passes.
struct AzimuthalAsymmetry {
  double amplitude = 0.0;
  double brightest_azimuth = 0.0;
};

std::optional<AzimuthalAsymmetry> azimuthal_asymmetry(std::span<const Occultation> of_one_elevation);

} // namespace keeler
