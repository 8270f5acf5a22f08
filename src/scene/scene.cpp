#include <keeler/scene/scene.hpp>

#include <keeler/scene/layer.hpp>

#include <keeler/core/units.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::scene {

LayerSizes ParticleSettings::layer_sizes() const {
  return scene::layer_sizes(sizes, count);
}

double ParticleSettings::bunching() const {
  double sum = streamlines.bunching;
  for (const ModeSettings& mode : modes)
    sum += mode.amplitude;
  return sum;
}

double Scene::step_length() const {
  return two_pi * time.step;
}

double Scene::oscillations_per_step() const {
  return time.automatic ? 0.0 : time.step * std::max(planet.frequencies.kappa, planet.frequencies.nu);
}

double Scene::surface_density() const {
  return optical_depth() * (start_from ? 0.0 : surface_density_per_depth(particles.sizes, particles.density));
}

double Scene::optical_depth() const {
  if (start_from)
    return 0.0;
  assert(size_x > 0.0 && size_y > 0.0);
  return static_cast<double>(particles.count) * pi * particles.sizes.mean_power(2) / (size_x * size_y);
}

double Scene::bunched_optical_depth() const {
  assert(particles.count > 0 && particles.free_count() <= particles.count);
  assert(particles.bunching() < 1.0);
  const double free = static_cast<double>(particles.free_count()) / static_cast<double>(particles.count);
  return free * optical_depth() * particles.pattern.peak() / (1.0 - particles.bunching());
}

} // namespace keeler::scene
