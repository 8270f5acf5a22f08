#include <keeler/diagnostics/wakes.hpp>

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace keeler::diagnostics {
namespace {

constexpr double min_amplitude = 0.02; // that of density waves of 20 %: no published wake is weaker
constexpr double min_ridge_significance = 5.0;
constexpr double inner_end = 0.5, outer_end = 1.5; // parts of the crest, in λ_cr from zero lag
constexpr std::size_t min_rows = 3;                // for a fit of the direction of a part

// Returns the mean of ξ over a line of half-length `reach` through (dx, 0), at an angle `pitch` (rad) to the y axis.
double line_mean(const AutocorrelationMap& map, double dx, double pitch, double reach) {
  const double step = 0.5 * std::min(map.spacing_x, map.spacing_y);
  const int half = static_cast<int>(std::ceil(reach / step));
  double sum = 0.0;
  for (int k = -half; k <= half; ++k) {
    const double s = reach * k / half;
    sum += map.at(dx + s * std::sin(pitch), -s * std::cos(pitch));
  }
  return sum / (2 * half + 1);
}

// Returns the top of a parabola through three equally spaced values, in steps from the middle one.
double parabola_top(double before, double middle, double after) {
  const double curvature = before - 2.0 * middle + after;
  return curvature < 0.0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0.0;
}

struct Ridge {
  double pitch_degrees, amplitude;
};

Ridge find_ridge(const AutocorrelationMap& map, double reach) {
  constexpr int steps = 180; // of one degree
  std::vector<double> means(steps);
  double all = 0.0;
  for (int k = 0; k < steps; ++k) {
    means[static_cast<std::size_t>(k)] = line_mean(map, 0.0, (k - 89) * pi / steps, reach);
    all += means[static_cast<std::size_t>(k)] / steps;
  }
  const auto top = static_cast<int>(std::max_element(means.begin(), means.end()) - means.begin());
  const auto mean = [&](int k) { return means[static_cast<std::size_t>((k + steps) % steps)]; };
  return {top - 89 + parabola_top(mean(top - 1), mean(top), mean(top + 1)), mean(top) - all};
}

// A point of the crest, the largest ξ at its Δy.
struct CrestPoint {
  double dx, dy, xi;
  double distance() const { return std::hypot(dx, dy); }
};

// Follows the crest outward, row by row of Δy, from its direction at zero lag to the point where it falls below the
// noise.
std::vector<CrestPoint> follow_crest(const AutocorrelationMap& map, double first_guess, double reach) {
  const double step = 0.25 * map.spacing_x;
  const double lean = -std::tan(first_guess) * map.spacing_y; // Δx of the crest from one row to the next
  double crest = 0.0;
  std::vector<CrestPoint> points;
  for (double dy = map.spacing_y; dy <= reach; dy += map.spacing_y) {
    const double expected = points.empty() ? lean : crest + crest / (dy - map.spacing_y) * map.spacing_y;
    double best = -HUGE_VAL;
    for (int k = -8; k <= 8; ++k)
      if (const double dx = expected + k * step; map.at(dx, dy) > best) {
        best = map.at(dx, dy);
        crest = dx;
      }
    if (best <= 3.0 * map.noise)
      break;
    points.push_back({crest, dy, best});
  }
  return points;
}

// Returns the pitch (rad) of a line through the origin fitted to the crest, Δx = −tan(pitch) Δy. A row has the weight
// ξ Δy², as in a fit of Δx: the far part of the ridge decides, not the clumps at its centre, which lean more than the
// wake does.
double pitch_through_centre(std::span<const CrestPoint> crest, double first_guess) {
  double xy = 0.0, yy = 0.0;
  for (const CrestPoint& p : crest) {
    xy += p.xi * p.dx * p.dy;
    yy += p.xi * p.dy * p.dy;
  }
  return yy > 0.0 ? -std::atan(xy / yy) : first_guess;
}

// Returns the pitch (rad) of a line with free intercept fitted to a part of the crest. Precondition: two rows or more.
double pitch_of_part(std::span<const CrestPoint> crest) {
  assert(crest.size() >= 2);
  double weight = 0.0, x = 0.0, y = 0.0;
  for (const CrestPoint& p : crest) {
    weight += p.xi;
    x += p.xi * p.dx;
    y += p.xi * p.dy;
  }
  double xy = 0.0, yy = 0.0;
  for (const CrestPoint& p : crest) {
    xy += p.xi * (p.dx - x / weight) * (p.dy - y / weight);
    yy += p.xi * (p.dy - y / weight) * (p.dy - y / weight);
  }
  return -std::atan(xy / yy);
}

// Returns the crest up to a distance from zero lag, which increases from row to row.
std::span<const CrestPoint> within(std::span<const CrestPoint> crest, double distance) {
  const auto end =
      std::find_if(crest.begin(), crest.end(), [&](const CrestPoint& p) { return p.distance() > distance; });
  return crest.first(static_cast<std::size_t>(end - crest.begin()));
}

// Smooths a profile that is even about its first entry by a Gaussian.
std::vector<double> smooth(const std::vector<double>& profile, double sigma) {
  assert(sigma > 0.0);
  const int count = static_cast<int>(profile.size()),
            half = static_cast<int>(std::min(std::ceil(3.0 * sigma), 2.0 * count));
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

// Returns the first maximum beyond the first valley, in entries: it exceeds its valleys on both sides by `prominence`,
// and half of the rise from the deepest valley to the mean density, since a shoulder in the empty lane is not a wake.
std::optional<double> first_side_maximum(const std::vector<double>& profile, double prominence) {
  assert(!profile.empty());
  const double risen = 0.5 * std::min(0.0, *std::min_element(profile.begin(), profile.end()));
  double lowest = profile[0];
  std::size_t top = 0; // 0: no rise yet
  for (std::size_t k = 1; k < profile.size(); ++k) {
    lowest = std::min(lowest, profile[k]);
    if (top == 0 ? profile[k] > std::max(risen, lowest + prominence) : profile[k] > profile[top])
      top = k;
    else if (top != 0 && profile[k] < profile[top] - prominence)
      return static_cast<double>(top) + parabola_top(profile[top - 1], profile[top], profile[top + 1]);
  }
  return std::nullopt;
}

} // namespace

Wakes find_wakes(const AutocorrelationMap& map, double critical_wavelength) {
  assert(map.values.size() == static_cast<std::size_t>(2 * map.reach + 1) * static_cast<std::size_t>(map.rows));
  Wakes wakes;
  const double spacing = std::max(map.spacing_x, map.spacing_y);
  // A line that starts at half a box must stay on the map, which ends at three quarters of it.
  wakes.reach = std::min({0.75 * critical_wavelength, map.half_height(), map.half_width() / 3.0});
  wakes.profile_spacing = 0.5 * map.spacing_x;
  if (!(critical_wavelength > 4.0 * spacing && wakes.reach > 2.0 * spacing))
    return wakes;

  const Ridge ridge = find_ridge(map, wakes.reach);
  wakes.amplitude = ridge.amplitude;
  const double line_noise = map.noise / std::sqrt(wakes.reach / spacing); // ξ is even: half of a line is independent
  double pitch = ridge.pitch_degrees * pi / 180.0;
  std::vector<CrestPoint> crest;
  if (std::fabs(pitch) < pi / 4.0) { // else the ridge is nearly parallel to the rows of Δy
    const double first_guess = pitch;
    crest = follow_crest(map, first_guess, std::min(outer_end * critical_wavelength, map.half_height()));
    const double fitted = std::min(critical_wavelength, map.half_height());
    const auto far = std::find_if(crest.begin(), crest.end(), [&](const CrestPoint& p) { return p.dy > fitted; });
    pitch = pitch_through_centre({crest.begin(), far}, first_guess);
  }
  const int count = static_cast<int>(map.half_width() * (2.0 / 3.0) / wakes.profile_spacing) + 1;
  for (int k = 0; k < count; ++k)
    wakes.profile.push_back(line_mean(map, k * wakes.profile_spacing, pitch, wakes.reach));
  if (ridge.amplitude < std::max(min_amplitude, min_ridge_significance * line_noise))
    return wakes;

  wakes.pitch_degrees = pitch * 180.0 / pi;
  const auto inner = within(crest, inner_end * critical_wavelength);
  if (inner.size() >= min_rows)
    wakes.inner_pitch_degrees = pitch_through_centre(inner, pitch) * 180.0 / pi;
  const auto outer = within(crest, outer_end * critical_wavelength).subspan(inner.size());
  if (outer.size() >= min_rows && outer.back().distance() > critical_wavelength)
    wakes.outer_pitch_degrees = pitch_of_part(outer) * 180.0 / pi;
  const std::vector<double> smoothed = smooth(wakes.profile, critical_wavelength / 20.0 / wakes.profile_spacing);
  if (const auto entry = first_side_maximum(smoothed, 3.0 * line_noise))
    wakes.spacing = *entry * wakes.profile_spacing;
  return wakes;
}

} // namespace keeler::diagnostics
