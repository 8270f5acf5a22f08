#include <keeler/render/autocorrelation_picture.hpp>

#include "raster.hpp"

#include <keeler/core/units.hpp>
#include <keeler/plot/axes.hpp>

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

const PlotLook picture_look{dark_theme, 17.0};

// Draws the colour bar right of the map.
void draw_key(Page& page, double full) {
  constexpr int left = static_cast<int>(map_left + map_size) + 14, width = 14, height = 260;
  Raster bar(width, height, space_colour);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      bar.pixel(i, j) = colour_of(full * (1.0 - 2.0 * (j + 0.5) / height), full);
  page.draw_pixels(bar.pixels(), bar.width(), left, static_cast<int>(map_top));
  page.frame(left, map_top, width, height, mix(page_colour, faint_ink, 0.5));
  for (const double end : {1.0, 0.0, -1.0})
    page.text({left + width + 6.0, map_top + 0.5 * height * (1.0 - end) +
                                       (end > 0.0   ? 13.0
                                        : end < 0.0 ? 0.0
                                                    : 6.0)},
              fmt::format("{:.2g}", end * full), {15, faint_ink});
  page.text({left + 1.0, map_top + height + 24.0}, "ξ", {19});
}

// Draws the map of lags up to `half` metres.
void draw_map(Page& page, const AutocorrelationMap& map, const Wakes& wakes, double half) {
  Raster raster(static_cast<int>(map_size), static_cast<int>(map_size), space_colour);
  const double full = full_scale(map);
  for (int j = 0; j < raster.height(); ++j)
    for (int i = 0; i < raster.width(); ++i)
      raster.pixel(i, j) =
          colour_of(map.at(half * (2.0 * (i + 0.5) / map_size - 1.0), half * (1.0 - 2.0 * (j + 0.5) / map_size)), full);
  page.draw_pixels(raster.pixels(), raster.width(), static_cast<int>(map_left), static_cast<int>(map_top));
  draw_key(page, full);
  const PlotFrame frame({map_left, map_top, map_size, map_size}, {.label = "radial lag Δx (m)", .range = {-half, half}},
                        {.label = "lag along the orbit Δy (m)", .range = {-half, half}}, picture_look);
  frame.draw_axes(page);
  if (!wakes.pitch_degrees)
    return;
  const double pitch = *wakes.pitch_degrees * pi / 180.0;
  page.begin_clip(map_left, map_top, map_size, map_size);
  page.line(frame.at(-2 * half * std::sin(pitch), 2 * half * std::cos(pitch)),
            frame.at(2 * half * std::sin(pitch), -2 * half * std::cos(pitch)), accent, 2.0, true);
  for (const double side : {-1.0, 1.0})
    if (wakes.spacing)
      page.dot(frame.at(side * *wakes.spacing, 0.0), 6.0, accent);
  page.end_clip();
}

void draw_profile(Page& page, const Wakes& wakes, double critical_wavelength) {
  if (wakes.profile.size() < 2) {
    page.text({plot_left + 0.5 * plot_width, map_top + 0.5 * map_size}, "λ_{cr} is not resolved",
              {22, faint_ink, Align::centre});
    return;
  }
  const double end = wakes.profile_spacing * static_cast<double>(wakes.profile.size() - 1);
  AxisRange range;
  for (const double xi : wakes.profile)
    range.include(xi);
  range = {range.low - 0.08 * (range.high - range.low), range.high + 0.08 * (range.high - range.low)};
  const PlotFrame frame({plot_left, map_top, plot_width, map_size}, {.label = "radial lag Δx (m)", .range = {0.0, end}},
                        {.label = "ξ averaged along the ridge", .range = range}, picture_look);
  page.shade(plot_left, map_top, plot_width, map_size, space_colour, 1.0);
  frame.draw_axes(page);
  page.line(frame.at(0.0, 0.0), frame.at(end, 0.0), frame.line_colour(), 1.5);
  if (critical_wavelength < end) {
    const double at = frame.at(critical_wavelength, 0.0).x;
    page.line({at, map_top + map_size}, {at, map_top}, faint_ink, 1.5, true);
    page.text({at + 10, map_top + 30}, "λ_{cr}", {20, faint_ink});
  }
  std::vector<PagePoint> points;
  for (std::size_t k = 0; k < wakes.profile.size(); ++k)
    points.push_back(frame.at(static_cast<double>(k) * wakes.profile_spacing, wakes.profile[k]));
  page.curve(points, {0.97, 0.82, 0.58}, 3.0);
  if (wakes.spacing) {
    const double top = wakes.profile[static_cast<std::size_t>(std::lround(*wakes.spacing / wakes.profile_spacing))];
    page.line(frame.at(*wakes.spacing, range.low), frame.at(*wakes.spacing, top), accent, 2.0, true);
    page.dot(frame.at(*wakes.spacing, top), 6.0, accent);
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
  draw_map(page, map, wakes, std::min({2.0 * critical_wavelength, map.half_height(), map.half_width() / 1.5}));
  draw_profile(page, wakes, critical_wavelength);
  page.save(path);
}

} // namespace keeler
