#include <keeler/light/photometry.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/linear_algebra.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::light {
namespace {

constexpr double per_degree = pi / 180.0;
constexpr int azimuth_harmonics = 3;

} // namespace

Vec3 Bearing::direction() const {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

double Sight::phase() const {
  const Vec3 o = observer.direction(), s = sun.direction();
  return std::atan2(o.cross(s).norm(), o.dot(s));
}

double Sight::longitude() const {
  const double angle = std::fmod(-observer.azimuth, two_pi);
  return angle < 0.0 ? angle + two_pi : angle + 0.0; // no −0
}

bool Sight::lit() const {
  return observer.elevation * sun.elevation > 0.0;
}

Sight sight_at_phase(const Bearing& observer, double sun_elevation, double phase) {
  const double least = std::fabs(observer.elevation - sun_elevation);
  const double most = pi - std::fabs(observer.elevation + sun_elevation);
  constexpr double rounding = 1e-9;
  if (!(phase >= least - rounding && phase <= most + rounding))
    throw UsageError(fmt::format(
        "with the observer at the elevation {} and the Sun at {} degrees the phase angle is from {} to {} degrees, not "
        "{}; change one of them",
        format_number(observer.elevation / per_degree), format_number(sun_elevation / per_degree),
        format_number(least / per_degree), format_number(most / per_degree), format_number(phase / per_degree)));
  const double across = std::cos(observer.elevation) * std::cos(sun_elevation);
  // by half angles, which keep the digits of a small difference
  const auto squared = [](double sine) { return sine * sine; };
  const double half = squared(std::sin(0.5 * phase)) - squared(std::sin(0.5 * (observer.elevation - sun_elevation)));
  const double between = across > 0.0 ? 2.0 * std::asin(std::sqrt(std::clamp(half / across, 0.0, 1.0))) : 0.0;
  return {observer, {sun_elevation, observer.azimuth + between}};
}

std::vector<Sight> sight_grid(std::span<const double> elevations, std::span<const double> sun_elevations,
                              std::span<const double> phases, std::span<const double> azimuths) {
  std::vector<Sight> sights;
  for (const double& elevation : elevations)
    for (const double sun : sun_elevations.empty() ? std::span(&elevation, 1) : sun_elevations)
      for (const double phase : phases)
        for (const double azimuth : azimuths)
          sights.push_back(sight_at_phase({elevation, azimuth}, sun, phase));
  return sights;
}

std::optional<BrightnessAsymmetry> brightness_asymmetry(std::span<const Photometry> of_one_elevation) {
  constexpr int terms = 1 + 2 * azimuth_harmonics;
  const auto count = static_cast<Eigen::Index>(of_one_elevation.size());
  if (count < terms + 1)
    return std::nullopt;
  Eigen::MatrixXd waves(count, terms);
  Eigen::VectorXd values(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Photometry& one = of_one_elevation[static_cast<std::size_t>(k)];
    values[k] = one.reflectance.value;
    waves(k, 0) = 1.0;
    for (int n = 1; n <= azimuth_harmonics; ++n) {
      waves(k, 2 * n - 1) = std::cos(2.0 * n * one.sight.longitude());
      waves(k, 2 * n) = std::sin(2.0 * n * one.sight.longitude());
    }
  }
  const LeastSquares fit = least_squares(waves, values);
  if (fit.rank < terms)
    return std::nullopt;
  const Eigen::VectorXd coefficients = fit.solution;
  const auto brightness = [&](double longitude) {
    double sum = coefficients[0];
    for (int n = 1; n <= azimuth_harmonics; ++n)
      sum +=
          coefficients[2 * n - 1] * std::cos(2.0 * n * longitude) + coefficients[2 * n] * std::sin(2.0 * n * longitude);
    return sum;
  };
  double low = brightness(0.0), high = low, error = 0.0;
  BrightnessAsymmetry result;
  constexpr int steps = 1800; // 0.1°
  for (int k = 1; k < steps; ++k) {
    const double longitude = pi * k / steps, value = brightness(longitude);
    high = std::max(high, value);
    if (value < low) {
      low = value;
      result.minimum_longitude = longitude;
    }
  }
  for (const Photometry& one : of_one_elevation)
    error += one.reflectance.error * one.reflectance.error / static_cast<double>(count);
  if (!(high + low > 0.0))
    return std::nullopt;
  result.amplitude = (high - low) / (high + low);
  // a coefficient has the error σ √(2/N); maximum and minimum differ by about twice the amplitude of the wave
  result.error = std::sqrt(error) * std::sqrt(2.0 / static_cast<double>(count)) / (0.5 * (high + low));
  return result;
}

} // namespace keeler::light
