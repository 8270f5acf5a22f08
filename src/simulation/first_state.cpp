#include "first_state.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {
namespace {

SimulationState first_state(const Scene& scene, const Patch& start) {
  require_sound(start);
  require_apart(start, "the initial state");
  const double largest = start.size() ? *std::max_element(start.radii.begin(), start.radii.end()) : 0.0;
  if (!(std::min(start.box.size_x, start.box.size_y) >= 2.0 * largest))
    throw UsageError(
        fmt::format("the box of the initial state, {:.4g} m x {:.4g} m, is smaller than its largest particle "
                    "({:.4g} m across); start from another state",
                    start.box.size_x, start.box.size_y, 2.0 * largest));
  SimulationState state(scene);
  if (scene.time.automatic)
    state.control = StepControl::automatic(!state.forces.empty());
  state.step_length = static_cast<double>(state.control.step) * scene.step_length();
  state.box = start.box;
  state.box.shear = scene.planet.frequencies.shear();
  state.box.first_offset = start.offset;
  Patch patch = start;
  patch.frequencies = scene.planet.frequencies;
  if (!scene.collisions.friction)
    patch.spins.clear();
  else if (patch.spins.empty()) // no spin against the stars
    patch.spins.assign(patch.size(), Vec3::Zero());
  state.particles = particles_from(patch, 0.5 * state.step_length);
  const double offset = state.epoch_offset();
  for (Body& body : state.particles.bodies) {
    Elements& el = body.elements;
    el = state.box.image_of(el, state.box.image_into_cell(el.guiding_x, el.guiding_y, offset), offset);
  }
  for (std::size_t k = 0; k < state.moonlets.size(); ++k) // a fresh patch is in the order of the ids
    state.moonlets[k].start_x = state.particles.bodies[start.size() - state.moonlets.size() + k].elements.guiding_x;
  const ParticleMeans means = particle_means(state.particles, scene.planet.frequencies, -0.5 * state.step_length);
  state.energy = {means.epicyclic_energy, means.azimuthal, means.spin.energy};
  return state;
}

// Collective: what the first rank has of all but the particles, on the others too.
void share(SimulationState& state, const Ranks& ranks) {
  const FieldTable table = state.fields();
  for (const Field& field : table.fields())
    if (!field.divided) {
      field.resize(ranks.from_first(field.rows()));
      ranks.from_first(std::span(static_cast<std::byte*>(field.data()), field.bytes()));
    }
}

} // namespace

SimulationState first_state(const Scene& scene, const Patch& start, const Ranks& ranks) {
  SimulationState state(scene);
  ranks.first_does([&] { state = first_state(scene, start); });
  share(state, ranks);
  return state;
}

} // namespace keeler
