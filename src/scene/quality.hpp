// quality = "fast", "balanced" or "strict": numbers for the keys of accuracy that a scene does not give; a scene that
// names no quality is "balanced". The numbers come from a table (docs/manual/scene.md) and from the scene's own keys,
// never from a clock, and are part of the resolved scene.
#pragma once

#include "settings.hpp"

#include <keeler/scene/scene.hpp>

namespace keeler {

/// Adds the keys of [gravity]. The document need not be checked yet.
void add_gravity_of_quality(SceneDocument& document);

/// Names the quality "custom" in the scene of a run from before there were qualities. Any other names all that a
/// quality gives.
void name_quality_of_stored(SceneDocument& document, const std::string& name);

/// Sets the step and the kick interval; all but the times has been read.
void resolve_times_of_quality(Scene& scene, Settings& settings);

} // namespace keeler
