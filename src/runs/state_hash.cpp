#include <keeler/runs/state_hash.hpp>

#include <keeler/io/hash.hpp>

#include <algorithm>
#include <numeric>

namespace keeler {

std::string state_hash(const SimulationState& state, const Scene& scene) {
  const Particles& particles = state.particles;
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return particles.ids[a] < particles.ids[b]; });
  Hash hash;
  for (const std::size_t k : order) {
    hash.add(particles.ids[k]);
    hash.add(particles.bodies[k]);
  }
  hash.add(state.step);
  hash.add(state.step_length);
  hash.add(state.box);
  hash.add(state.boundary_offset());
  hash.add_text(scene.motion);
  return hash.hex();
}

} // namespace keeler
