// quality = "fast", "balanced" or "strict": values for the keys of accuracy that a scene does not give; the default is
// "balanced". The values follow from a table (docs/manual/scene.md) and from other keys of the scene, never from a
// clock, and are part of the resolved scene.
#pragma once

#include <keeler/config/settings.hpp>
#include <keeler/scene/scene.hpp>

namespace keeler::scene {

/// Adds the keys of [gravity]. The document may be unchecked.
void add_gravity_of_quality(config::TomlDocument& document);

/// Sets the quality of a stored scene without one to "custom": it is of a version without qualities. A later stored
/// scene holds all values that its quality gave.
void name_quality_of_stored(config::TomlDocument& document, const std::string& name);

/// Sets the step and the kick interval. Precondition: all but the times has been read.
void resolve_times_of_quality(Scene& scene, config::Settings& settings);

} // namespace keeler::scene
