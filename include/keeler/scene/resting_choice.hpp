// Whether contacts at rest carry the kicks or bounce, where a scene leaves that open (gravity.resting_contacts =
// "auto"). The choice follows from what is in the patch and from the kick interval: it is the same of a fresh start, of
// a snapshot and of a table. docs/dev/contact-solver.md has the measurements behind it.
#pragma once

#include <keeler/scene/scene.hpp>
#include <keeler/scene/warnings.hpp>

#include <string>

namespace keeler {

/// Returns by which share the loss in collisions exceeds the work of the shear where all contacts bounce, kicks being
/// that many orbits apart.
double excess_of_bouncing(double optical_depth, double hill_parameter, double kick_interval);

/// Returns whether grains stay on a body: it is much larger than they are, and the Hill radius of the two is at least
/// their radius sum.
bool holds_grains(const PatchScale::Sphere& body, const PatchScale::Sphere& grain, const PlanetSettings& planet);

/// A choice, and why: "aggregates last at r_h 1.2".
struct RestingChoice {
  bool carried = false;
  std::string reason;
};

/// Returns the choice for a patch, by the planet and the kick interval of the scene.
RestingChoice choose_resting_contacts(const PatchScale& patch, const Scene& scene);

/// Returns whether the scene leaves the choice to its start: its resolved text says "auto".
bool leaves_resting_open(const Scene& scene);

/// Returns the scene with the choice that its start decides, also in its resolved text. A scene that leaves nothing
/// open is returned as it is.
Scene decided_by(const Scene& scene, const PatchScale& start);

} // namespace keeler
