#include <keeler/runs/state_hash.hpp>

#include <keeler/io/hash.hpp>
#include <keeler/particles/order.hpp>

namespace keeler {

std::string state_hash(const SimulationState& state, const Scene& scene) {
  const Particles& particles = state.particles;
  Hash hash;
  for (const std::uint32_t k : order_by_id(particles.ids)) {
    hash.add(particles.ids[k]);
    hash.add(particles.bodies[k]);
    if (particles.rough)
      hash.add_bytes(std::as_bytes(std::span(particles.spins[k].data(), 3)));
  }
  hash.add(state.step);
  hash.add(state.step_length);
  hash.add(state.control.kick);
  hash.add(state.box);
  hash.add(state.boundary_offset());
  hash.add_text(scene.motion);
  return hash.hex();
}

} // namespace keeler
