// Warnings of a start far from any ring: units or the shear are probably wrong.
#include <keeler/advice/warnings.hpp>

#include <keeler/core/format.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::advice {
namespace {

using Lines = std::vector<std::string>;

// Streamlines of a perturbed ring, bunched as much as they can be without crossing, change dv_y/dx by a seventh of the
// shear.
void warn_of_shear(const scene::StartScale& start, Lines& lines) {
  constexpr double near = 0.25;
  if (!start.shear_seen || std::fabs(*start.shear_seen - 1.0) < near)
    return;
  const double rate = start.shear * start.orbital_frequency, seen = *start.shear_seen * rate;
  if (std::fabs(*start.shear_seen) < near)
    lines.push_back(
        fmt::format("the velocities lack the shear: dv_y/dx is {} rad/s, on circular orbits it is {}; add {} x "
                    "(x in m) to v_y (in m/s)",
                    format_number(-seen, 3), format_number(-rate, 4), format_number(-rate, 4)));
  else if (std::fabs(*start.shear_seen + 1.0) < near)
    lines.push_back(
        fmt::format("the shear of the velocities has the wrong sign: dv_y/dx is {} rad/s, on circular orbits it is "
                    "{}; x must point outward, y along the orbit",
                    format_number(-seen, 3), format_number(-rate, 4)));
  else
    lines.push_back(fmt::format("dv_y/dx is {} rad/s, {} times that of circular orbits ({}): are lengths in m and "
                                "velocities in m/s, both in Hill's frame?",
                                format_number(-seen, 3), format_number(*start.shear_seen, 3), format_number(-rate, 4)));
}

// A start that is to cool may be several times hotter than a ring (examples/quaoar: three escape speeds).
void warn_of_speeds(const scene::StartScale& start, Lines& lines) {
  constexpr double hot = 15.0;
  const double usual = start.usual_dispersion, unit = start.mean_radius;
  if (start.dispersion > hot * usual)
    lines.push_back(fmt::format("the velocity dispersion is {} mm/s ({} mean r Omega); collisions and self-gravity "
                                "maintain about {}: are velocities in m/s and radii in m?",
                                format_number(1e3 * start.dispersion * start.orbital_frequency, 3),
                                format_number(start.dispersion / unit, 3), format_number(usual / unit, 2)));
  if (start.height > hot * usual)
    lines.push_back(fmt::format("the layer is {} m high (the standard deviation of z); a ring of these particles has "
                                "about {} m: are z and radii in m?",
                                format_number(start.height, 3), format_number(usual, 2)));
}

// Rings have optical depths from 1e-6 (Jupiter's, Saturn's E ring) to some 5 (Saturn's B ring).
void warn_of_lengths(const scene::StartScale& start, Lines& lines) {
  constexpr double thinnest = 1e-6, thickest = 10.0, crowded = 100.0;
  if (start.flat && std::min(start.spread_x, start.spread_y) > crowded)
    lines.push_back(fmt::format("all particles are in the central {} % of the box: are positions and the box in m?",
                                format_number(100.0 / std::min(start.spread_x, start.spread_y), 2)));
  else if (start.optical_depth < thinnest)
    lines.push_back(fmt::format("the optical depth is {}, below that of any ring: are radii and the box in m?",
                                format_number(start.optical_depth, 2)));
  else if (start.optical_depth > thickest)
    lines.push_back(fmt::format("the optical depth is {}, above that of any ring: are radii and the box in m?",
                                format_number(start.optical_depth, 3)));
}

} // namespace

std::vector<std::string> warnings(const scene::StartScale& start) {
  constexpr std::size_t enough = 10; // fewer particles are an experiment on single bodies
  Lines lines;
  if (start.particle_count < enough)
    return lines;
  warn_of_lengths(start, lines);
  warn_of_shear(start, lines);
  warn_of_speeds(start, lines);
  return lines;
}

} // namespace keeler::advice
