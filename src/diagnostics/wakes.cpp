#include <keeler/diagnostics/wakes.hpp>

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

constexpr double least_amplitude = 0.02; // relative density waves of 20 %: no published wake is weaker
constexpr double least_significance = 5.0;

constexpr double core = 0.3; // of the reach: shorter lags show the shape of single clumps

// Mean of ξ over a line through (dx, 0), turned by `pitch` (rad) from the y axis, at distances from `from` to `reach` on
// both sides of that point.
double line_mean(const AutocorrelationMap& map, double dx, double pitch, double from, double reach) {
  const double step = 0.5 * std::min(map.spacing_x, map.spacing_y);
  const int half = static_cast<int>(std::ceil(reach / step)), first = static_cast<int>(from / reach * half);
  double sum = 0.0;
  for (int k = first; k <= half; ++k) {
    const double s = reach * k / half, dy = s * std::cos(pitch);
    sum += map.at(dx + s * std::sin(pitch), -dy) + map.at(dx - s * std::sin(pitch), dy);
  }
  return 0.5 * sum / (half - first + 1);
}

// Where a parabola through three equally spaced values has its top, in steps from the middle one.
double parabola_top(double before, double middle, double after) {
  const double curvature = before - 2.0 * middle + after;
  return curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

struct Ridge {
  double pitch_degrees, amplitude;
};

Ridge find_ridge(const AutocorrelationMap& map, double reach) {
  constexpr int steps = 180; // of a degree
  std::vector<double> means(steps);
  double all = 0.0;
  for (int k = 0; k < steps; ++k) {
    means[static_cast<std::size_t>(k)] = line_mean(map, 0.0, (k - 89) * pi / steps, core * reach, reach);
    all += means[static_cast<std::size_t>(k)] / steps;
  }
  const auto top = static_cast<int>(std::max_element(means.begin(), means.end()) - means.begin());
  const auto mean = [&](int k) { return means[static_cast<std::size_t>((k + steps) % steps)]; };
  return {top - 89 + parabola_top(mean(top - 1), mean(top), mean(top + 1)), mean(top) - all};
}

// Gaussian smoothing of a profile that is even about its first entry.
std::vector<double> smooth(const std::vector<double>& profile, double sigma) {
  const int count = static_cast<int>(profile.size()), half = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> smoothed(profile.size());
  for (int i = 0; i < count; ++i) {
    double sum = 0.0, weights = 0.0;
    for (int j = i - half; j <= i + half; ++j) {
      if (std::abs(j) >= count)
        continue;
      const double u = (j - i) / sigma, weight = std::exp(-0.5 * u * u);
      sum += weight * profile[static_cast<std::size_t>(std::abs(j))];
      weights += weight;
    }
    smoothed[static_cast<std::size_t>(i)] = sum / weights;
  }
  return smoothed;
}

// The first maximum beyond zero lag, in entries: more crowded than at random (ξ > 0: a shoulder in the empty lane
// beside a wake is not the next wake) and above its valleys on both sides by `prominence`.
std::optional<double> first_side_maximum(const std::vector<double>& profile, double prominence) {
  double lowest = profile[0];
  std::size_t top = 0; // 0: no rise seen yet
  for (std::size_t k = 1; k < profile.size(); ++k) {
    lowest = std::min(lowest, profile[k]);
    if (top == 0 ? profile[k] > std::max(0.0, lowest + prominence) : profile[k] > profile[top])
      top = k;
    else if (top != 0 && profile[k] < profile[top] - prominence)
      return static_cast<double>(top) + parabola_top(profile[top - 1], profile[top], profile[top + 1]);
  }
  return std::nullopt;
}

} // namespace

Wakes find_wakes(const AutocorrelationMap& map, double critical_wavelength) {
  Wakes wakes;
  const double spacing = std::max(map.spacing_x, map.spacing_y);
  // A line that starts at half a box must stay on the map, which ends at three quarters of it.
  wakes.reach = std::min({1.5 * critical_wavelength, map.half_height(), map.half_width() / 2.0});
  wakes.profile_spacing = 0.5 * map.spacing_x;
  if (!(critical_wavelength > 4.0 * spacing && wakes.reach > 2.0 * spacing))
    return wakes;

  const Ridge ridge = find_ridge(map, wakes.reach);
  wakes.amplitude = ridge.amplitude;
  const double line_noise = map.noise / std::sqrt(wakes.reach / spacing); // ξ is even: half a line is independent
  const double pitch = ridge.pitch_degrees * pi / 180.0;
  const int count = static_cast<int>(map.half_width() * (2.0 / 3.0) / wakes.profile_spacing) + 1;
  for (int k = 0; k < count; ++k)
    wakes.profile.push_back(line_mean(map, k * wakes.profile_spacing, pitch, 0.0, wakes.reach));
  if (ridge.amplitude < std::max(least_amplitude, least_significance * line_noise))
    return wakes;

  wakes.pitch_degrees = ridge.pitch_degrees;
  const std::vector<double> smoothed = smooth(wakes.profile, critical_wavelength / 20.0 / wakes.profile_spacing);
  const double depth = smoothed[0] - *std::min_element(smoothed.begin(), smoothed.end());
  if (const auto entry = first_side_maximum(smoothed, std::max(0.03 * depth, 3.0 * line_noise)))
    wakes.spacing = *entry * wakes.profile_spacing;
  return wakes;
}

} // namespace keeler
