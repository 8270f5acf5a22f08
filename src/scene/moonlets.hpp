// The scene's [[moonlet]] tables: bodies at places of their own among the particles.
#pragma once

#include "settings.hpp"

#include <keeler/scene/scene.hpp>

#include <vector>

namespace keeler {

std::vector<Key> moonlet_keys();

/// Of a scene that goes on too: how many there are, runs must know.
std::vector<MoonletSettings> read_moonlets(Settings& settings, const std::string& name);

} // namespace keeler
