#include <keeler/runs/state_hash.hpp>

#include <keeler/io/hash.hpp>
#include <keeler/particles/by_id.hpp>

#include <cassert>
#include <span>

namespace keeler::runs {

std::string state_hash(const simulation::SimulationState& state, const Scene& scene, const Communicator& ranks) {
  constexpr std::size_t rows = std::size_t{1} << 16;
  assert(!state.particles.rough || state.particles.spins.size() == state.particles.size());
  io::Hash hash;
  visit_by_id(state.particles, ranks, rows, [&](const Particles& particles) {
    for (std::size_t k = 0; k < particles.size(); ++k) {
      hash.add(particles.ids[k]);
      hash.add(particles.bodies[k]);
      if (particles.rough)
        hash.add_bytes(std::as_bytes(std::span(particles.spins[k].data(), 3)));
    }
  });
  hash.add(state.step);
  hash.add(state.step_length);
  hash.add(state.control.kick);
  hash.add(state.box);
  hash.add(state.boundary_offset());
  hash.add_text(scene.motion);
  std::string digits = hash.hex();
  ranks.broadcast(digits);
  return digits;
}

} // namespace keeler::runs
