#include <keeler/render/autocorrelation_picture.hpp>

#include "page.hpp"

#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {
namespace {

// Blue for negative ξ (depletion), black for 0 (random), through red to ivory for positive ξ (crowding).
constexpr std::array<Colour, 4> crowded = {Colour{0.02, 0.02, 0.04}, Colour{0.50, 0.11, 0.20}, Colour{0.93, 0.53, 0.20},
                                           Colour{1.0, 0.97, 0.84}};
constexpr std::array<Colour, 3> sparse = {Colour{0.02, 0.02, 0.04}, Colour{0.10, 0.26, 0.46}, Colour{0.42, 0.68, 0.86}};

// Steeper than linear near zero, so that faint side ridges are visible.
Colour colour_of(double xi, double full) {
  assert(full > 0.0);
  const double strength = std::pow(std::fabs(xi) / full, 0.7);
  return xi >= 0.0 ? ramp(crowded, strength) : ramp(sparse, strength);
}

// Returns the end of the scale: the 99.5th percentile, which excludes the peak of single clumps at zero lag.
double full_scale(const AutocorrelationMap& map) {
  std::vector<double> values = map.values;
  const auto high = values.begin() + static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), high, values.end());
  return std::max(*high, 1e-6);
}

constexpr double map_left = 120, map_top = 130, map_size = 620, plot_left = 940, plot_width = 600;

// Maps lags to pixels of the square map, which extends ± `half` metres.
struct MapView {
  double half;
  PagePoint at(double dx, double dy) const {
    const double scale = 0.5 * map_size / half;
    return {map_left + 0.5 * map_size + scale * dx, map_top + 0.5 * map_size - scale * dy};
  }
};

double tick_step(double range) {
  const double power = std::pow(10.0, std::floor(std::log10(range / 4.0)));
  for (const double step : {5.0, 2.0, 1.0})
    if (range / (step * power) >= 3.0)
      return step * power;
  return power;
}

// Draws the colour bar right of the map.
void draw_key(Page& page, double full) {
  constexpr int left = static_cast<int>(map_left + map_size) + 14, width = 14, height = 260;
  Raster bar(width, height, space_colour);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      bar.pixel(i, j) = colour_of(full * (1.0 - 2.0 * (j + 0.5) / height), full);
  page.draw_raster(bar, left, static_cast<int>(map_top));
  page.frame(left, map_top, width, height, mix(page_colour, faint_ink, 0.5));
  for (const double end : {1.0, 0.0, -1.0})
    page.text({left + width + 6.0, map_top + 0.5 * height * (1.0 - end) +
                                       (end > 0.0   ? 13.0
                                        : end < 0.0 ? 0.0
                                                    : 6.0)},
              fmt::format("{:.2g}", end * full), {15, faint_ink});
  page.text({left + 1.0, map_top + height + 24.0}, "ξ", {19});
}

void draw_map(Page& page, const AutocorrelationMap& map, const Wakes& wakes, const MapView& view) {
  Raster raster(static_cast<int>(map_size), static_cast<int>(map_size), space_colour);
  const double full = full_scale(map);
  for (int j = 0; j < raster.height(); ++j)
    for (int i = 0; i < raster.width(); ++i)
      raster.pixel(i, j) = colour_of(
          map.at(view.half * (2.0 * (i + 0.5) / map_size - 1.0), view.half * (1.0 - 2.0 * (j + 0.5) / map_size)), full);
  page.draw_raster(raster, static_cast<int>(map_left), static_cast<int>(map_top));
  draw_key(page, full);
  page.frame(map_left, map_top, map_size, map_size, mix(page_colour, faint_ink, 0.5));

  const double step = tick_step(view.half);
  for (double k = -std::floor(view.half / step); k * step <= view.half; ++k) {
    const double lag = k * step;
    const PagePoint x = view.at(lag, -view.half), y = view.at(-view.half, lag);
    page.line({x.x, x.y}, {x.x, x.y + 8}, faint_ink, 1.5);
    page.text({x.x, x.y + 30}, fmt::format("{:g}", lag), {17, faint_ink, Align::centre});
    page.line({y.x - 8, y.y}, {y.x, y.y}, faint_ink, 1.5);
    page.text({y.x - 14, y.y + 6}, fmt::format("{:g}", lag), {17, faint_ink, Align::right});
  }
  page.text({map_left + 0.5 * map_size, map_top + map_size + 62}, "radial lag Δx, m", {19, ink, Align::centre});
  page.text({map_left - 68, map_top + 0.5 * map_size}, "lag along the orbit Δy, m", {19, ink, Align::centre}, true);

  if (!wakes.pitch_degrees)
    return;
  const double pitch = *wakes.pitch_degrees * pi / 180.0;
  page.begin_clip(map_left, map_top, map_size, map_size);
  page.line(view.at(-2 * view.half * std::sin(pitch), 2 * view.half * std::cos(pitch)),
            view.at(2 * view.half * std::sin(pitch), -2 * view.half * std::cos(pitch)), accent, 2.0, true);
  for (const double side : {-1.0, 1.0})
    if (wakes.spacing)
      page.dot(view.at(side * *wakes.spacing, 0.0), 6.0, accent);
  page.end_clip();
}

void draw_profile(Page& page, const Wakes& wakes, double critical_wavelength) {
  page.shade(plot_left, map_top, plot_width, map_size, space_colour, 1.0);
  page.frame(plot_left, map_top, plot_width, map_size, mix(page_colour, faint_ink, 0.5));
  page.text({plot_left + 0.5 * plot_width, map_top + map_size + 62}, "radial lag Δx, m", {19, ink, Align::centre});
  page.text({plot_left - 80, map_top + 0.5 * map_size}, "ξ averaged along the ridge", {19, ink, Align::centre}, true);
  if (wakes.profile.size() < 2) {
    page.text({plot_left + 0.5 * plot_width, map_top + 0.5 * map_size}, "λ_{cr} is not resolved",
              {22, faint_ink, Align::centre});
    return;
  }
  const double end = wakes.profile_spacing * static_cast<double>(wakes.profile.size() - 1);
  const auto [min, max] = std::minmax_element(wakes.profile.begin(), wakes.profile.end());
  const double margin = 0.08 * (*max - *min), low = *min - margin, high = *max + margin;
  const auto at = [=](double lag, double xi) {
    return PagePoint{plot_left + plot_width * lag / end, map_top + map_size * (high - xi) / (high - low)};
  };
  const double lag_step = tick_step(end);
  for (double k = 0.0; k * lag_step <= end; ++k) {
    const double lag = k * lag_step;
    const PagePoint p = at(lag, low);
    page.line(p, {p.x, p.y + 8}, faint_ink, 1.5);
    page.text({p.x, p.y + 30}, fmt::format("{:g}", lag), {17, faint_ink, Align::centre});
  }
  const double step = tick_step(high - low);
  for (double k = std::ceil(low / step); k * step <= high; ++k) {
    const double xi = k * step;
    const PagePoint p = at(0.0, xi);
    page.line({p.x - 8, p.y}, p, faint_ink, 1.5);
    page.text({p.x - 14, p.y + 6}, fmt::format("{:g}", k == 0.0 ? 0.0 : xi), {17, faint_ink, Align::right});
  }
  page.line(at(0.0, 0.0), at(end, 0.0), mix(page_colour, faint_ink, 0.5), 1.5);
  if (critical_wavelength < end) {
    page.line(at(critical_wavelength, low), at(critical_wavelength, high), faint_ink, 1.5, true);
    page.text({at(critical_wavelength, high).x + 10, map_top + 30}, "λ_{cr}", {20, faint_ink});
  }
  std::vector<PagePoint> points;
  for (std::size_t k = 0; k < wakes.profile.size(); ++k)
    points.push_back(at(static_cast<double>(k) * wakes.profile_spacing, wakes.profile[k]));
  page.curve(points, {0.97, 0.82, 0.58}, 3.0);
  if (wakes.spacing) {
    const double top = wakes.profile[static_cast<std::size_t>(std::lround(*wakes.spacing / wakes.profile_spacing))];
    page.line(at(*wakes.spacing, low), at(*wakes.spacing, top), accent, 2.0, true);
    page.dot(at(*wakes.spacing, top), 6.0, accent);
  }
}

} // namespace

void render_autocorrelation(const AutocorrelationMap& map, const Wakes& wakes, double critical_wavelength,
                            const std::string& path, const std::string& title) {
  Page page(1600, 860, page_colour);
  page.text({60, 58}, title, {32, ink, Align::left, true});
  std::string facts =
      fmt::format("autocorrelation of the surface density      λ_{{cr}} = {:.1f} m      ", critical_wavelength);
  facts += wakes.pitch_degrees ? fmt::format("pitch = {:.1f}°      ", *wakes.pitch_degrees) : "no wakes";
  if (wakes.spacing)
    facts += fmt::format("radial spacing = {:.1f} m = {:.2f} λ_{{cr}}", *wakes.spacing,
                         *wakes.spacing / critical_wavelength);
  page.text({60, 98}, facts, {21, faint_ink});
  draw_map(page, map, wakes, {std::min({2.0 * critical_wavelength, map.half_height(), map.half_width() / 1.5})});
  draw_profile(page, wakes, critical_wavelength);
  page.save(path);
}

} // namespace keeler
