// Colours and colour ramps, in sRGB from 0 to 1.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace keeler::plot {

struct Colour {
  double r = 0, g = 0, b = 0;
};

/// Interpolates: `from` at t = 0, `to` at t = 1.
inline Colour mix(const Colour& from, const Colour& to, double t) {
  return {from.r + t * (to.r - from.r), from.g + t * (to.g - from.g), from.b + t * (to.b - from.b)};
}

/// Interpolates linearly between evenly spaced colours; t is clamped to [0, 1].
template<std::size_t n> Colour ramp(const std::array<Colour, n>& stops, double t) {
  const double u = std::clamp(t, 0.0, 1.0) * static_cast<double>(n - 1);
  const std::size_t k = std::min(static_cast<std::size_t>(u), n - 2);
  return mix(stops[k], stops[k + 1], u - static_cast<double>(k));
}

inline constexpr Colour page_colour{0.047, 0.051, 0.066};
inline constexpr Colour space_colour{0.012, 0.014, 0.024};
inline constexpr Colour ink{0.93, 0.91, 0.86};
inline constexpr Colour faint_ink{0.62, 0.61, 0.60};

/// The colours of a page around its views.
struct Theme {
  Colour page, ink, faint_ink;
};
inline constexpr Theme dark_theme{page_colour, ink, faint_ink};
inline constexpr Theme light_theme{{1.0, 1.0, 1.0}, {0.10, 0.10, 0.12}, {0.36, 0.36, 0.38}};

} // namespace keeler::plot
