#include <keeler/particles/patch.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keeler {

Patch make_patch(const Particles& particles, const ShearingBox& box, double offset, const Frequencies& frequencies,
                 double after) {
  const std::size_t count = particles.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return particles.ids[a] < particles.ids[b]; });

  Patch patch;
  patch.box = box;
  patch.offset = offset;
  patch.frequencies = frequencies;
  const Rotation rotation(frequencies, after);
  for (const std::size_t k : order) {
    const Body& body = particles.bodies[k];
    const State state = state_at(body.elements, frequencies, rotation);
    patch.positions.push_back(state.position);
    patch.velocities.push_back(state.velocity);
    patch.radii.push_back(body.radius);
    patch.masses.push_back(body.mass);
    patch.ids.push_back(particles.ids[k]);
  }
  return patch;
}

void require_sound(const Patch& patch) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const auto refuse = [&](const char* what) {
      throw InvariantError(fmt::format("particle {} has {}; take another state", patch.ids[k], what));
    };
    if (!patch.positions[k].allFinite() || !patch.velocities[k].allFinite())
      refuse("a place or a velocity that is not finite");
    if (!positive(patch.radii[k]))
      refuse("a radius that is not positive");
    if (!positive(patch.masses[k]))
      refuse("a mass that is not positive");
  }
}

Particles particles_from(const Patch& patch, double ahead) {
  Particles particles;
  particles.ids = patch.ids;
  const Rotation rotation(patch.frequencies, -ahead);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const State state{patch.positions[k], patch.velocities[k]};
    particles.bodies.push_back({elements_from(state, patch.frequencies, rotation), patch.radii[k], patch.masses[k]});
  }
  return particles;
}

} // namespace keeler
