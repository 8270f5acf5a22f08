// What a simulation shows of its particles: patches, at a boundary between two steps or where an interrupted one
// stopped.
#include <keeler/simulation/simulation.hpp>

#include <keeler/core/units.hpp>
#include <keeler/particles/by_id.hpp>

#include <cassert>
#include <cmath>

namespace keeler::simulation {

// The patch at time `after` (rad) since the epoch, with the box's shear offset at that time.
Patch Simulation::patch_of(const Particles& particles, double offset, double after) const {
  Patch patch = make_patch(particles, state_.box, offset, scene_.planet.frequencies, after);
  patch.orbital_frequency = scene_.planet.orbital_frequency;
  patch.time_orbits = orbits() + (after + 0.5 * state_.step_length) / two_pi;
  return patch;
}

Patch Simulation::patch_of(const Particles& particles) const {
  return patch_of(particles, state_.boundary_offset(), -0.5 * state_.step_length);
}

Patch Simulation::patch() const {
  assert(!ranks_.distributed());
  return patch_of(state_.particles);
}

Patch Simulation::frame() const {
  return patch_of(Particles());
}

void Simulation::visit_patch(std::size_t rows, const std::function<void(const Patch&)>& piece) const {
  visit_by_id(state_.particles, ranks_, rows, [&](const Particles& some) { piece(patch_of(some)); });
}

Patch Simulation::patch_at_break() const {
  return patch_of(state_.particles, offset_at_break(), time_at_break());
}

double Simulation::offset_at_break() const {
  if (!drifting_)
    return state_.boundary_offset();
  const double offset = state_.epoch_offset() + state_.box.shear * state_.box.size_x * time_at_break();
  return offset - std::floor(offset / state_.box.size_y) * state_.box.size_y;
}

} // namespace keeler::simulation
