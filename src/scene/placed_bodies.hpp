// Bodies at positions that the scene gives: moonlets and aggregates.
#pragma once

#include <keeler/config/settings.hpp>
#include <keeler/scene/scene.hpp>

namespace keeler::scene {

/// Throws UsageError for the first body that lies outside the box, is too large for it, or overlaps another body.
void check_placed_bodies(const Scene& scene, const config::Settings& settings);

} // namespace keeler::scene
