// Sizes, box and number of particles, each of which the scene may give in more than one way.
#pragma once

#include <keeler/config/settings.hpp>
#include <keeler/scene/scene.hpp>

namespace keeler::scene {

/// Reads the scene's particles and box. `name` is the scene file. Precondition: scene.planet is set.
void read_particles_and_box(Scene& scene, config::Settings& settings, const std::string& name);

} // namespace keeler::scene
