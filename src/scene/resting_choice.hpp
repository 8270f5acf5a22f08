// Chooses whether contacts at rest carry the kicks or bounce, where a scene leaves it open (gravity.resting_contacts =
// "auto"). The choice depends on the bodies of the patch and on the kick interval only, so a fresh start, a snapshot
// and a table of one patch give one choice. docs/dev/contact-solver.md has the measurements behind it.
#pragma once

#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/planet.hpp>
#include <keeler/scene/scene.hpp>

#include <string>

namespace keeler::scene {

/// Returns the energy that kicks give to bouncing contacts over the work of the shear, by a fit. `hill_parameter` is
/// r_h; `kick_interval` is in orbits.
double energy_of_kicks(double optical_depth, double hill_parameter, double kick_interval);

/// True if grains stay on a body: it is much larger than they are, and the mutual Hill radius is at least the radius
/// sum.
bool holds_grains(const PatchScale::Sphere& body, const PatchScale::Sphere& grain, const PlanetSettings& planet);

/// A choice, and its reason: "aggregates last at r_h 1.2".
struct RestingChoice {
  bool carried = false;
  std::string reason;
};

/// Returns the choice for a patch, with the planet and the kick interval of the scene.
RestingChoice choose_resting_contacts(const PatchScale& patch, const Scene& scene);

} // namespace keeler::scene
