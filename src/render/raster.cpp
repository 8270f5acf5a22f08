#include "raster.hpp"

#include <keeler/core/memory.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::render {
namespace {

constexpr double min_radius =
    0.6; // pixels; a smaller sphere is drawn with this radius but fainter, with equal total light
constexpr double shadow_reach = 1.45; // radii
constexpr double shadow_depth = 0.45; // at the rim, where it is darkest
constexpr double shadow_radius = 5.0; // pixels; shadows of smaller spheres fade, otherwise distant views would darken
constexpr double light[] = {-0.42, -0.52, 0.744}; // from the upper left, y down; unit vector

// Returns the brightness of a sphere at (u, v), in radii from its centre: ambient light, a facing term, and a lamp.
double lit(double u, double v) {
  const double w = std::sqrt(std::max(0.0, 1.0 - u * u - v * v));
  const double lamp = std::max(0.0, u * light[0] + v * light[1] + w * light[2]);
  return 0.30 + 0.12 * w + 0.62 * lamp;
}

} // namespace

Raster::Raster(int width, int height, const plot::Colour& background)
    : width_(width), height_(height),
      pixels_(affordable_size(static_cast<double>(width) * height, sizeof(plot::Colour),
                              fmt::format("a picture of {} x {} pixels", width, height), "lower its width"),
              background) {}

void Raster::sphere(double x, double y, double radius, const plot::Colour& colour) {
  assert(radius > 0.0);
  const double drawn = std::max(radius, min_radius);
  const double light_fraction = radius * radius / (drawn * drawn);
  const double shadow = shadow_depth * light_fraction * std::min(1.0, drawn / shadow_radius);
  const double reach = shadow_reach * drawn + 0.5;
  const int left = std::max(0, static_cast<int>(std::floor(x - reach)));
  const int right = std::min(width_ - 1, static_cast<int>(std::floor(x + reach)));
  const int top = std::max(0, static_cast<int>(std::floor(y - reach)));
  const int bottom = std::min(height_ - 1, static_cast<int>(std::floor(y + reach)));
  for (int j = top; j <= bottom; ++j)
    for (int i = left; i <= right; ++i) {
      const double u = i + 0.5 - x, v = j + 0.5 - y, distance = std::sqrt(u * u + v * v);
      plot::Colour& here = pixel(i, j);
      const double outside =
          (distance / drawn - 1.0) / (shadow_reach - 1.0); // 0 at the rim, 1 at the end of the shadow
      if (outside < 1.0) {
        const double depth = 1.0 - std::max(0.0, outside);
        here = mix(here, {0.0, 0.0, 0.0}, shadow * depth * depth);
      }
      const double cover = std::clamp(drawn - distance + 0.5, 0.0, 1.0);
      if (cover > 0.0) {
        const double brightness = lit(u / drawn, v / drawn);
        const plot::Colour shaded{std::min(1.0, colour.r * brightness), std::min(1.0, colour.g * brightness),
                                  std::min(1.0, colour.b * brightness)};
        here = mix(here, shaded, cover * light_fraction);
      }
    }
}

} // namespace keeler::render
