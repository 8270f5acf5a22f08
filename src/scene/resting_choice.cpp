#include <keeler/scene/resting_choice.hpp>

#include <keeler/core/format.hpp>
#include <keeler/core/units.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::scene {
namespace {

constexpr double aggregates_last = 1.0;     // r_h
constexpr double much_energy = 0.015;       // of kicks over that of the shear (docs/dev/contact-solver.md)
constexpr double much_larger = 3.0;         // radius of a body over that of its grains
constexpr double automatic_interval = 8e-3; // orbits: typical of an automatic step in wakes
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

// A fit to the table of tests/unit/scene/resting_choice.cpp: optical depths 1 to 3, r_h 0.6 to 1.2, kicks 1e-3 to 1e-2
// orbits apart.
double energy_of_kicks(double optical_depth, double hill_parameter, double kick_interval) {
  assert(optical_depth >= 0.0 && hill_parameter >= 0.0 && kick_interval > 0.0);
  return 0.033 * std::pow(optical_depth, 1.2) * std::pow(hill_parameter / 0.93, 7.5) * (kick_interval / 5e-3);
}

RestingChoice choose_resting_contacts(const PatchScale& patch, const Scene& scene) {
  const double r_h = hill_parameter(patch.density, distance_from_saturn(scene.planet));
  if (r_h >= aggregates_last)
    return {true, fmt::format("aggregates last at r_h {}", format_number(r_h, 3))};
  if (patch.largest.mass >= min_mass_fraction * patch.mass && holds_grains(patch.largest, patch.grain, scene.planet))
    return {true, fmt::format("grains stay on a body of {} m", format_number(patch.largest.radius, 3))};
  const double interval =
      scene.time.automatic ? automatic_interval : scene.time.step * static_cast<double>(scene.kick_interval());
  const double energy = energy_of_kicks(patch.optical_depth, r_h, interval);
  return {energy >= much_energy,
          fmt::format("kicks give bouncing contacts about {} % of the energy that the shear supplies",
                      format_number(100.0 * energy, 2))};
}

} // namespace keeler::scene
