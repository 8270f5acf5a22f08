// What a scene puts at places of its own: moonlets and aggregates.
#pragma once

#include "settings.hpp"

#include <keeler/scene/scene.hpp>

namespace keeler {

/// Throws UsageError at the first that stands outside the box or is too large for it, or that overlaps another.
void check_placed_bodies(const Scene& scene, const Settings& settings);

} // namespace keeler
