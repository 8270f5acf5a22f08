// Warnings: valid but unusual settings, and results that a patch cannot resolve. `keeler check` and runs print them.
#pragma once

#include <keeler/forces/satellite.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::advice {

/// Returns a line for each property of a start that is far from any ring: a unit or the shear is probably wrong.
std::vector<std::string> warnings(const scene::StartScale& start);

/// Returns a line with numbers for each warning.
std::vector<std::string> warnings(const Scene& scene, const scene::PatchScale& patch);

/// As above, before there is a patch. If a start file holds it, only the time step and forces are checked.
std::vector<std::string> warnings(const Scene& scene);

/// Returns the first passage of the scene's satellite from `from` to `until` (orbits) that a cell cannot represent
/// well.
std::optional<forces::SatellitePassage> unresolved_passage(const Scene& scene, double from, double until);

/// Returns a sentence on what such a passage does, and what to do instead.
std::string in_words(const forces::SatellitePassage& passage);

/// Returns the coefficient of restitution above which collisions of smooth spheres lose less energy than the shear
/// supplies, so that the velocity dispersion grows without limit: (1 − ε²)(1 + τ²) = 0.61 (Goldreich & Tremaine 1978).
double critical_restitution(double optical_depth);

} // namespace keeler::advice
