// What a simulation shows of its particles: patches, at a boundary between two steps or where an interrupted one
// stopped.
#include <keeler/simulation/simulation.hpp>

#include <keeler/core/units.hpp>
#include <keeler/particles/by_id.hpp>
#include <keeler/particles/order.hpp>

#include <algorithm>
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

std::vector<Body> Simulation::bodies_of(std::span<const std::uint64_t> ids) {
  std::vector<Body> found;
  std::vector<std::uint64_t> found_ids;
  for (const std::uint32_t k : own_among(ids, state_.particles.size())) {
    found.push_back(state_.particles.bodies[k]);
    found_ids.push_back(state_.particles.ids[k]);
  }
  found = ranks_.gather_on_all(std::span<const Body>(found));
  found_ids = ranks_.gather_on_all(std::span<const std::uint64_t>(found_ids));
  assert(found.size() == ids.size());
  std::vector<Body> bodies(ids.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    bodies[static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), found_ids[k]) - ids.begin())] = found[k];
  return bodies;
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

std::size_t Simulation::visit_at_break(std::size_t rows, const std::function<bool(const Patch&, std::size_t)>& keeps,
                                       const std::function<void(const Patch&, std::size_t)>& begin,
                                       const std::function<void(const Patch&)>& piece) const {
  const double offset = offset_at_break(), after = time_at_break();
  const Patch here = patch_of(state_.particles, offset, after); // in the order of the ids
  const std::vector<std::uint32_t> order = particles::order_by_id(state_.particles.ids);
  Particles kept;
  kept.rough = state_.particles.rough;
  for (std::size_t k = 0; k < here.size(); ++k)
    if (keeps(here, k)) {
      kept.bodies.push_back(state_.particles.bodies[order[k]]);
      kept.ids.push_back(state_.particles.ids[order[k]]);
      if (kept.rough)
        kept.spins.push_back(state_.particles.spins[order[k]]);
    }
  const std::size_t count = ranks_.sum(kept.size());
  ranks_.on_root([&] { begin(patch_of(Particles(), offset, after), count); });
  visit_by_id(kept, ranks_, rows, [&](const Particles& some) { piece(patch_of(some, offset, after)); });
  return count_ - count;
}

double Simulation::offset_at_break() const {
  if (!drifting_)
    return state_.boundary_offset();
  const double offset = state_.epoch_offset() + state_.box.shear * state_.box.size_x * time_at_break();
  return offset - std::floor(offset / state_.box.size_y) * state_.box.size_y;
}

} // namespace keeler::simulation
