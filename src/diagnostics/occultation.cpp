#include <keeler/diagnostics/occultation.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::diagnostics {

FlickerMoments flicker_moments(std::span<const double> transmissions) {
  assert(!transmissions.empty());
  const auto count = static_cast<double>(transmissions.size());
  double mean = 0.0, second = 0.0, third = 0.0, fourth = 0.0;
  for (const double t : transmissions)
    mean += t / count;
  for (const double t : transmissions) {
    const double d = t - mean;
    second += d * d / count;
    third += d * d * d / count;
    fourth += d * d * d * d / count;
  }
  FlickerMoments moments;
  moments.variance = second;
  if (second > 1e-24) { // beyond rounding
    moments.skewness = third / std::pow(second, 1.5);
    moments.kurtosis = fourth / (second * second) - 3.0;
  }
  return moments;
}

Occultation occultation(std::span<const Patch> patches, const RayLattice& rays, const LineOfSight& sight) {
  assert(!patches.empty());
  Occultation result;
  result.sight = sight;
  std::vector<double> singles, footprints;
  double mean = 0.0, error_squares = 0.0;
  const auto count = static_cast<double>(patches.size());
  for (const Patch& patch : patches) {
    const std::vector<std::uint8_t> blocked = rays.blocked(patch, sight);
    const RayMean one = ray_mean(blocked);
    singles.push_back(one.transmission);
    mean += one.transmission / count;
    error_squares += one.error * one.error;
    const std::vector<double> transmissions = rays.transmissions(blocked);
    footprints.insert(footprints.end(), transmissions.begin(), transmissions.end());
  }
  result.transmission = statistics::measured(mean, singles);
  result.ray_error = std::sqrt(error_squares) / count;
  const double sine = std::sin(sight.elevation);
  if (mean > 0.0) {
    result.normal_optical_depth = mean < 1.0 ? -sine * std::log(mean) : 0.0;
    result.normal_optical_depth_error = sine * result.ray_error / mean;
  }
  result.flicker = flicker_moments(footprints);
  return result;
}

std::optional<AzimuthalAsymmetry> azimuthal_asymmetry(std::span<const Occultation> of_one_elevation) {
  const auto less = [](const Occultation& a, const Occultation& b) {
    return *a.transmission.value < *b.transmission.value;
  };
  if (of_one_elevation.size() < 2)
    return std::nullopt;
  const auto [darkest, brightest] = std::minmax_element(of_one_elevation.begin(), of_one_elevation.end(), less);
  const double min_t = *darkest->transmission.value, max_t = *brightest->transmission.value;
  if (!(max_t > 0.0))
    return std::nullopt;
  return AzimuthalAsymmetry{(max_t - min_t) / (max_t + min_t), brightest->sight.azimuth};
}

} // namespace keeler::diagnostics
