#include <keeler/particles/patch.hpp>

#include <keeler/core/error.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/particles/order.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::particles {

Patch make_patch(const Particles& particles, const ShearingBox& box, double offset, const Frequencies& frequencies,
                 double after) {
  const std::size_t count = particles.size();
  assert(particles.ids.size() == count && (!particles.rough || particles.spins.size() == count));
  const std::vector<std::uint32_t> order = order_by_id(particles.ids);
  Patch patch;
  patch.box = box;
  patch.offset = offset;
  patch.frequencies = frequencies;
  patch.positions.resize(count);
  patch.velocities.resize(count);
  patch.radii.resize(count);
  patch.masses.resize(count);
  patch.ids.resize(count);
  const Rotation rotation(frequencies, after);
  parallel_for(count, [&](std::size_t k) {
    const Body& body = particles.bodies[order[k]];
    const State state = state_at(body.elements, frequencies, rotation);
    patch.positions[k] = state.position;
    patch.velocities[k] = state.velocity;
    patch.radii[k] = body.radius;
    patch.masses[k] = body.mass;
    patch.ids[k] = particles.ids[order[k]];
  });
  if (particles.rough) {
    const SpinTurn turn(after);
    patch.spins.resize(count);
    parallel_for(count, [&](std::size_t k) { patch.spins[k] = turn.from_epoch(particles.spins[order[k]]); });
  }
  return patch;
}

void require_sound(const Patch& patch) {
  assert(patch.spins.empty() || patch.spins.size() == patch.size());
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const auto refuse = [&](const char* what) {
      throw InvariantError(fmt::format("particle {} has {}; take another state", patch.ids[k], what));
    };
    if (!patch.positions[k].allFinite() || !patch.velocities[k].allFinite())
      refuse("a position or velocity that is not finite");
    if (!positive(patch.radii[k]))
      refuse("a radius that is not positive");
    if (!positive(patch.masses[k]))
      refuse("a mass that is not positive");
    if (!patch.spins.empty() && !patch.spins[k].allFinite())
      refuse("a spin that is not finite");
  }
}

Particles particles_from(const Patch& patch, double ahead) {
  Particles particles;
  assert(patch.velocities.size() == patch.size() && patch.ids.size() == patch.size());
  assert(patch.radii.size() == patch.size() && patch.masses.size() == patch.size());
  particles.ids = patch.ids;
  particles.bodies.resize(patch.size());
  const Rotation rotation(patch.frequencies, -ahead);
  parallel_for(patch.size(), [&](std::size_t k) {
    const State state{patch.positions[k], patch.velocities[k]};
    particles.bodies[k] = {elements_from(state, patch.frequencies, rotation), patch.radii[k], patch.masses[k]};
  });
  particles.rough = !patch.spins.empty();
  if (particles.rough) {
    const SpinTurn turn(-ahead);
    particles.spins.resize(patch.size());
    parallel_for(patch.size(), [&](std::size_t k) { particles.spins[k] = turn.to_epoch(patch.spins[k]); });
  }
  return particles;
}

} // namespace keeler::particles
