#include "own_start.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/possible.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::initial_conditions {
namespace {

struct Sizes {
  std::vector<double> radii, masses;
};

Sizes sizes_of(const scene::ParticleSettings& particles) {
  const particles::DrawnSizes drawn(particles.sizes, particles.count, particles.seed);
  Sizes sizes;
  for (std::size_t k = 0; k < particles.count; ++k) {
    const double density = drawn.has_densities() ? drawn.density(k) : particles.density;
    sizes.radii.push_back(drawn.radius(k));
    sizes.masses.push_back(4.0 / 3.0 * pi * density * std::pow(sizes.radii[k], 3));
  }
  return sizes;
}

void require_possible_state(const Patch& patch, std::size_t k, const char* name) {
  std::string fault = particle_fault(patch, k);
  if (fault.empty())
    fault = box_fault({patch.positions[k], patch.velocities[k]}, patch.box, patch.frequencies);
  if (!fault.empty())
    throw UsageError(fmt::format("the start '{}' gives particle {} {}; correct it", name, k, fault));
}

void place(const Scene& scene, Patch& patch) {
  const scene::ParticleSettings& particles = scene.particles;
  const scene::StartSettings& start = *particles.start;
  const Sizes sizes = sizes_of(particles);
  const std::vector<State> states = start.entry->place(
      start.parameters, {sizes.radii, sizes.masses, patch.box, patch.frequencies, patch.orbital_frequency,
                         particles.velocity_dispersion * particles.sizes.mean_power(1), particles.seed});
  if (states.size() != particles.count)
    throw UsageError(fmt::format("the start '{}' places {} particles, but the scene has {}; correct it",
                                 start.entry->name, states.size(), particles.count));
  for (std::size_t k = 0; k < states.size(); ++k) {
    HeldBody{states[k].position, states[k].velocity, sizes.radii[k], sizes.masses[k]}.add_to(patch, k);
    require_possible_state(patch, k, start.entry->name);
  }
}

} // namespace

Patch placed_patch(const Scene& scene, const std::vector<HeldBody>& moonlets, const Communicator& ranks) {
  assert(scene.particles.start);
  Patch patch;
  patch.box = {scene.size_x, scene.size_y, scene.planet.frequencies.shear(), 0.0};
  patch.frequencies = scene.planet.frequencies;
  patch.orbital_frequency = scene.planet.orbital_frequency;
  ranks.on_root([&] {
    place(scene, patch);
    for (const HeldBody& moonlet : moonlets)
      moonlet.add_to(patch, patch.size());
  });
  return patch;
}

} // namespace keeler::initial_conditions
