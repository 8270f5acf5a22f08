#include <keeler/scene/resting_choice.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

constexpr double aggregates_last = 1.0;     // r_h
constexpr double rest_begins = 0.79;        // r_h, in a dense ring
constexpr double much_larger = 3.0;         // radius of a body over that of its grains
constexpr double min_mass_fraction = 0.001; // of the patch, in a body that must hold grains to matter

// Returns the Hill radius of two bodies over their radius sum, by equal spheres of the density below.
double pair_hill_parameter(const PatchScale::Sphere& a, const PatchScale::Sphere& b, double distance) {
  const double density = 3.0 / pi * (a.mass + b.mass) / std::pow(a.radius + b.radius, 3);
  return hill_parameter(density, distance);
}

} // namespace

// A large body holds grains at a lower density than grains hold each other.
bool holds_grains(const PatchScale::Sphere& body, const PatchScale::Sphere& grain, const PlanetSettings& planet) {
  assert(body.radius >= 0.0 && body.mass >= 0.0);
  return grain.radius > 0.0 && body.radius >= much_larger * grain.radius &&
         pair_hill_parameter(body, grain, distance_from_saturn(planet)) >= aggregates_last;
}

// From the table of tests/unit/scene/resting_choice.cpp. In a thinner ring wakes are fewer, and hold fewer spheres at
// rest.
double hill_parameter_of_rest(double optical_depth) {
  assert(optical_depth >= 0.0);
  return std::clamp(rest_begins * std::pow(optical_depth, -0.25), rest_begins, aggregates_last);
}

RestingChoice choose_resting_contacts(const PatchScale& patch, const PlanetSettings& planet) {
  const double r_h = hill_parameter(patch.density, distance_from_saturn(planet));
  if (r_h >= aggregates_last)
    return {true, fmt::format("aggregates last at r_h {}", format_number(r_h, 3))};
  if (patch.largest.mass >= min_mass_fraction * patch.mass && holds_grains(patch.largest, patch.grain, planet))
    return {true, fmt::format("grains stay on a body of {} m", format_number(patch.largest.radius, 3))};
  const double limit = hill_parameter_of_rest(patch.optical_depth);
  return {r_h >= limit,
          fmt::format("r_h {} is {} {}, from which on carrying saves time at this optical depth", format_number(r_h, 4),
                      r_h >= limit ? "at least" : "below", format_number(limit, 4))};
}

} // namespace keeler::scene
