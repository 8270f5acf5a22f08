// The keys and tables that a scene may have, in the order of the resolved scene: made once, by scene_keys() and
// scene_sections().
#pragma once

#include <keeler/scene/keys.hpp>

#include <vector>

namespace keeler {

std::vector<Key> make_keys();
std::vector<Section> make_sections();

} // namespace keeler
