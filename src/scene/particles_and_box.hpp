// How much ring there is: sizes, box and count, each of which the scene may give in more than one way.
#pragma once

#include "settings.hpp"

#include <keeler/scene/scene.hpp>

namespace keeler {

/// Fills in the scene's particles and box; the planet is already there. `name` is the scene file.
void read_particles_and_box(Scene& scene, Settings& settings, const std::string& name);

} // namespace keeler
