// The scene's [[moonlet]] tables: bodies among the particles, at given positions.
#pragma once

#include <keeler/config/settings.hpp>
#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler::scene {

std::vector<Key> moonlet_keys();

/// Returns the moonlets, also for a scene that is continued: a run needs their number.
std::vector<MoonletSettings> read_moonlets(config::Settings& settings, const std::string& name);

} // namespace keeler::scene
