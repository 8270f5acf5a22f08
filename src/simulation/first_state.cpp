#include "first_state.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/field_table.hpp>
#include <keeler/diagnostics/particle_means.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::simulation {
namespace {

void require_room(const ShearingBox& box, double largest, const std::string& name) {
  if (!(std::min(box.size_x, box.size_y) >= 2.0 * largest))
    throw UsageError(
        fmt::format("the box of {}, {:.4g} m x {:.4g} m, is smaller than its largest particle ({:.4g} m across); start "
                    "from another state",
                    name, box.size_x, box.size_y, 2.0 * largest));
}

// Collective.
void require_fit(const Scene& scene, const Patch& start, const std::string& name, const Communicator& ranks) {
  const std::uint64_t all = ranks.sum(start.size());
  ranks.together([&] {
    advice::require_memory_for(scene, start.size(), all);
    require_sound(start);
    if (!ranks.distributed())
      cells::require_no_overlap(start, name);
  });
  const double largest = ranks.max(start.size() ? *std::max_element(start.radii.begin(), start.radii.end()) : 0.0);
  ranks.on_root([&] { require_room(start.box, largest, name); });
}

// Broadcasts all fields but the particles from the root. Collective.
void broadcast_all_but_particles(SimulationState& state, const Communicator& ranks) {
  const FieldTable table = state.fields();
  for (const Field& field : table.fields())
    if (!field.divided) {
      field.resize(ranks.broadcast(field.rows()));
      ranks.broadcast(std::span(static_cast<std::byte*>(field.data()), field.bytes()));
    }
}

// Returns the particles of the patch, wrapped into the cell.
Particles particles_of(const Patch& start, const Scene& scene, const SimulationState& state) {
  Patch patch = start;
  patch.frequencies = scene.planet.frequencies;
  if (!scene.collisions.friction)
    patch.spins.clear();
  else if (patch.spins.empty()) // no spin relative to the stars
    patch.spins.assign(patch.size(), Vec3::Zero());
  Particles particles = particles_from(patch, 0.5 * state.step_length);
  particles.rough = scene.collisions.friction.has_value(); // on ranks without particles too
  const double offset = state.epoch_offset();
  for (Body& body : particles.bodies) {
    Elements& el = body.elements;
    el = state.box.image_of(el, state.box.image_into_cell(el.guiding_x, el.guiding_y, offset), offset);
  }
  return particles;
}

// Records the guiding centres of the moonlets. Only fresh patches have moonlets, all on the root. Collective.
void note_moonlets(SimulationState& state, const Communicator& ranks) {
  const std::size_t count = state.moonlets.size();
  if (count == 0)
    return;
  assert(!ranks.is_root() || state.particles.size() >= count);
  for (std::size_t k = 0; k < count && ranks.is_root(); ++k) // in the order of the ids they come last
    state.moonlets[k].start_x = state.particles.bodies[state.particles.size() - count + k].elements.guiding_x;
  broadcast_all_but_particles(state, ranks);
}

} // namespace

std::string start_name(const Scene& scene) {
  return scene.start_from ? fmt::format("'{}'", *scene.start_from) : "the initial state";
}

SimulationState first_state(const Scene& scene, const Patch& start, const Communicator& ranks) {
  assert(start.positions.size() == start.size() && start.velocities.size() == start.size());
  require_fit(scene, start, start_name(scene), ranks);
  SimulationState state(scene);
  if (scene.time.automatic)
    state.control = StepControl::automatic(!state.forces.empty());
  state.step_length = static_cast<double>(state.control.step) * scene.step_length();
  state.box = start.box;
  state.box.shear = scene.planet.frequencies.shear();
  state.box.first_offset = start.offset;
  broadcast_all_but_particles(state, ranks);
  state.particles = particles_of(start, scene, state);
  note_moonlets(state, ranks);
  const diagnostics::ParticleMeans means =
      diagnostics::particle_means(state.particles, scene.planet.frequencies, -0.5 * state.step_length, ranks);
  state.energy = {means.epicyclic_energy, means.azimuthal, means.spin.energy};
  return state;
}

} // namespace keeler::simulation
