#include <keeler/runs/state_hash.hpp>

#include <keeler/io/hash.hpp>
#include <keeler/particles/order.hpp>

namespace keeler {
namespace {

void add_scene(Hash& hash, const Scene& scene) {
  hash.add(scene.planet.orbital_frequency);
  hash.add(scene.planet.frequencies);
  hash.add(scene.particles.seed);
  const CollisionSettings& c = scene.collisions;
  hash.add_text(c.finder);
  hash.add(static_cast<std::int64_t>(c.restitution.kind));
  hash.add(c.restitution.kind == RestitutionLaw::Kind::constant ? c.restitution.value : c.restitution.scale);
  hash.add(c.elastic_below);
  if (!scene.gravity)
    return;
  hash.add(static_cast<std::int64_t>(scene.gravity->solver));
  hash.add(scene.gravity->opening_angle);
  hash.add(scene.gravity->force_error);
  hash.add(scene.gravity->mesh_spacing);
  hash.add(static_cast<std::int64_t>(scene.gravity->images.rings));
  hash.add(static_cast<std::int64_t>(scene.gravity->images.far));
  hash.add(static_cast<std::int64_t>(scene.gravity->kick_every));
}

} // namespace

std::string state_hash(const SimulationState& state, const Scene& scene) {
  const Particles& particles = state.particles;
  Hash hash;
  for (const std::uint32_t k : order_by_id(particles.ids)) {
    hash.add(particles.ids[k]);
    hash.add(particles.bodies[k]);
  }
  hash.add(state.step);
  hash.add(state.step_length);
  hash.add(state.box);
  hash.add(state.boundary_offset());
  add_scene(hash, scene);
  return hash.hex();
}

} // namespace keeler
