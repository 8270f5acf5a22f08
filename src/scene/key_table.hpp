// The keys and tables that a scene may have, in the order of the resolved scene. scene_schema() calls both functions
// once.
#pragma once

#include <keeler/config/schema.hpp>

#include <vector>

namespace keeler::scene {

std::vector<Key> make_keys();
std::vector<config::Section> make_sections();

} // namespace keeler::scene
