// The keys and tables that a scene may have, in the order of the resolved scene. scene_schema() calls both functions
// once.
#pragma once

#include <keeler/config/schema.hpp>

#include <vector>

namespace keeler {

std::vector<Key> make_keys();
std::vector<Section> make_sections();

} // namespace keeler
