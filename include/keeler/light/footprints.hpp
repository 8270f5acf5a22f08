// Statistics of a stellar occultation as observers publish them: the star's footprint moves over the ring, and each
// sample is the mean transmission of the area that it sweeps. Moments, autocovariance, and the effective particle
// radius (Showalter & Nicholson 1990, Icarus 87, 285; Colwell et al. 2018, Icarus 300, 150). There is no photon noise:
// excess variance and skewness are what is left when observers have taken it out.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/light/photometry.hpp>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace keeler::light {

/// How the footprint moves and how it is sampled.
struct FootprintTrack {
  double length = 10.0;     ///< that a sample sweeps in the ring plane, m
  double width = 10.0;      ///< across, m
  double azimuth = 0.0;     ///< of the motion in the ring plane, from +x towards +y, rad
  std::size_t tracks = 100; ///< at random places, per snapshot; at least 2
  std::size_t samples = 64; ///< one after the other on each track; at least 2
  std::size_t rays = 32;    ///< per sample; at least 4
  std::uint64_t seed = 1;   ///< of the places
};

/// What one line of sight shows. The finite number of rays adds nothing to the moments: they are made of numbers of
/// pairs, triples and quadruples of rays that pass. Errors come from the scatter of the tracks.
struct FootprintStatistics {
  Bearing star;                     ///< where it is seen
  Estimate transmission;            ///< mean T
  Estimate variance;                ///< of T; observers' excess variance over the square of the star's counts
  std::optional<Estimate> skewness; ///< third central moment over variance^{3/2}; empty unless the variance is above 0
  std::optional<double> kurtosis;   ///< fourth central moment over variance², less 3; empty likewise
  std::vector<double> autocovariance;  ///< of samples 0, 1, 2 … apart, up to half a track; the first is the variance
  std::optional<double> optical_depth; ///< normal: −sin B ln T; empty if no light passes
  std::optional<double>
      effective_radius; ///< m: of equal spheres at random with this T and variance; empty without a variance
};

/// Returns the statistics of all snapshots together at each bearing of the star (elevation ≠ 0). When the work is to be
/// abandoned (interrupt.hpp), returns those of the bearings that are done. Throws Error without Embree, UsageError for
/// a patch without particles.
std::vector<FootprintStatistics> footprint_statistics(std::span<const Patch> patches, std::span<const Bearing> stars,
                                                      const FootprintTrack& track,
                                                      const std::function<void(const Progress&)>& report = {});

} // namespace keeler::light
