// The keys and tables that a scene may have, in the order of the resolved scene: made once, by scene_keys() and
// scene_sections().
#pragma once

#include <keeler/scene/keys.hpp>

#include <vector>

namespace keeler {

/// Up to the densest metals, kg/m³.
inline constexpr KeyRange material_densities = {.low = 1e-2, .high = 3e4};

std::vector<Key> make_keys();
std::vector<Section> make_sections();

} // namespace keeler
