// The range of densities that a scene's bodies may have.
#pragma once

#include <keeler/core/key.hpp>

namespace keeler::scene {

/// Up to the densest metals, kg/m³.
inline constexpr KeyRange material_densities = {.low = 1e-2, .high = 3e4};

} // namespace keeler::scene
