// Chooses whether contacts at rest carry the kicks or bounce, where a scene leaves it open (gravity.resting_contacts =
// "auto"). The choice depends on the bodies of the patch and the planet only, so a fresh start, a snapshot and a table
// of one patch give one choice. docs/dev/contact-solver.md has the measurements behind it.
#pragma once

#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/planet.hpp>

#include <string>

namespace keeler::scene {

/// Returns the r_h from which on so many spheres of a ring rest on each other that it saves time to let them carry the
/// kicks. Source: runs of equal spheres at optical depths 0.3 to 3. Precondition: optical_depth >= 0.
double hill_parameter_of_rest(double optical_depth);

/// True if grains stay on a body: it is much larger than they are, and the mutual Hill radius is at least the radius
/// sum.
bool holds_grains(const PatchScale::Sphere& body, const PatchScale::Sphere& grain, const PlanetSettings& planet);

/// A choice, and its reason: "aggregates last at r_h 1.2".
struct RestingChoice {
  bool carried = false;
  std::string reason;
};

/// Returns the choice for a patch at this planet.
RestingChoice choose_resting_contacts(const PatchScale& patch, const PlanetSettings& planet);

} // namespace keeler::scene
