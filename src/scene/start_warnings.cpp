// A start that is far from any ring: units or the shear are probably wrong.
#include <keeler/scene/warnings.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

using Lines = std::vector<std::string>;

// Streamlines of a perturbed ring, bunched as far as they do not cross, turn v_y(x) by a seventh of the shear.
void doubt_shear(const StartScale& start, Lines& lines) {
  constexpr double near = 0.25;
  if (!start.shear_seen || std::fabs(*start.shear_seen - 1.0) < near)
    return;
  const double rate = start.shear * start.orbital_frequency, seen = *start.shear_seen * rate;
  if (std::fabs(*start.shear_seen) < near)
    lines.push_back(fmt::format("the velocities lack the shear: v_y changes with x by {} rad/s, on circular orbits by "
                                "{}; add {} x (x in m) to v_y in m/s",
                                format_number(-seen, 3), format_number(-rate, 4), format_number(-rate, 4)));
  else if (std::fabs(*start.shear_seen + 1.0) < near)
    lines.push_back(
        fmt::format("the shear of the velocities has the wrong sign: v_y grows with x by {} rad/s, where on "
                    "circular orbits it falls by {}; x points outward, y along the orbit",
                    format_number(-seen, 3), format_number(rate, 4)));
  else
    lines.push_back(fmt::format("v_y changes with x by {} rad/s, {} times as much as on circular orbits ({}): are "
                                "lengths in m and velocities in m/s, both in Hill's frame?",
                                format_number(-seen, 3), format_number(*start.shear_seen, 3), format_number(-rate, 4)));
}

// A start that is to cool may well be some times hotter than a ring (examples/quaoar: three escape speeds).
void doubt_motions(const StartScale& start, Lines& lines) {
  constexpr double hot = 15.0;
  const double usual = start.usual_dispersion, unit = start.mean_radius;
  if (start.dispersion > hot * usual)
    lines.push_back(fmt::format("the velocity dispersion is {} mm/s ({} mean r Omega), where collisions and "
                                "self-gravity keep up some {}: are velocities in m/s and radii in m?",
                                format_number(1e3 * start.dispersion * start.orbital_frequency, 3),
                                format_number(start.dispersion / unit, 3), format_number(usual / unit, 2)));
  if (start.height > hot * usual)
    lines.push_back(fmt::format("the layer is {} m high (the standard deviation of z), where a ring of these particles "
                                "has some {} m: are z and radii in m?",
                                format_number(start.height, 3), format_number(usual, 2)));
}

// Rings have optical depths from 1e-6 (Jupiter's, Saturn's E ring) to some 5 (Saturn's B ring).
void doubt_lengths(const StartScale& start, Lines& lines) {
  constexpr double thinnest = 1e-6, thickest = 10.0, crowded = 100.0;
  if (start.flat && std::min(start.spread_x, start.spread_y) > crowded)
    lines.push_back(fmt::format("all particles are in the middle {} % of the box: are their lengths in m, as the box's "
                                "are?",
                                format_number(100.0 / std::min(start.spread_x, start.spread_y), 2)));
  else if (start.optical_depth < thinnest)
    lines.push_back(fmt::format("the optical depth is {}, less than any ring has: are radii and the box in m?",
                                format_number(start.optical_depth, 2)));
  else if (start.optical_depth > thickest)
    lines.push_back(fmt::format("the optical depth is {}, more than any ring has: are radii and the box in m?",
                                format_number(start.optical_depth, 3)));
}

} // namespace

double usual_dispersion(double largest_radius, double largest_mass, double surface_density, double newton_g,
                        double kappa) {
  const double escape = std::sqrt(2.0 * newton_g * largest_mass / largest_radius);
  const double toomre = 2.0 * 3.36 * newton_g * surface_density / kappa; // Q = 2
  return std::max({largest_radius, escape, toomre});
}

std::vector<std::string> warnings(const StartScale& start) {
  constexpr std::size_t enough = 10; // fewer are no ring but an experiment on bodies
  Lines lines;
  if (start.particle_count < enough)
    return lines;
  doubt_lengths(start, lines);
  doubt_shear(start, lines);
  doubt_motions(start, lines);
  return lines;
}

} // namespace keeler
