#include <keeler/states/uniform.hpp>

#include "placing.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>

#include <cmath>
#include <numeric>

namespace keeler {
namespace {

// Epicycles of random phase: in the plane the velocity is all of them, vertically the half that is not the height.
Vec3 random_velocity(const UniformRequest& request, std::size_t k) {
  RandomStream random(request.seed, RandomPurpose::velocity, k);
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {request.dispersion_x * x, 0.5 * request.frequencies.kappa * request.dispersion_x * y,
          request.dispersion_z * z};
}

// The least change, by the sum of squares, that leaves no momentum: in proportion to the mass, so that one heavy
// particle does not set the light ones drifting.
void remove_momentum(Patch& patch) {
  const auto sum = [&](const auto& term) { return ordered_sum(patch.size(), term); };
  const double squares = sum([&](std::size_t k) { return patch.masses[k] * patch.masses[k]; });
  Vec3 momentum;
  for (int axis = 0; axis < 3; ++axis)
    momentum[axis] = sum([&](std::size_t k) { return patch.masses[k] * patch.velocities[k][axis]; });
  parallel_for(patch.size(), [&](std::size_t k) { patch.velocities[k] -= patch.masses[k] / squares * momentum; });
}

void centre_heights(Patch& patch) {
  const double mass = ordered_sum(patch.size(), [&](std::size_t k) { return patch.masses[k]; });
  const double moment =
      ordered_sum(patch.size(), [&](std::size_t k) { return patch.masses[k] * patch.positions[k].z(); });
  parallel_for(patch.size(), [&](std::size_t k) { patch.positions[k].z() -= moment / mass; });
}

void follow_streamlines(const UniformRequest& request, Patch& patch) {
  parallel_for(patch.size(), [&](std::size_t k) {
    const double guiding_x = request.streamlines.guiding_x(patch.positions[k].x());
    patch.velocities[k] += state_at(request.streamlines.elements(guiding_x), request.frequencies, Rotation()).velocity;
  });
}

void add(const HeldBody& body, Patch& patch) {
  patch.positions.push_back(body.place);
  patch.velocities.push_back(body.velocity);
  patch.radii.push_back(body.radius);
  patch.masses.push_back(body.mass);
  patch.ids.push_back(patch.ids.size());
}

Patch patch_at(const UniformRequest& request, std::vector<Vec3> places) {
  Patch patch;
  patch.box = request.box;
  patch.offset = request.box.first_offset;
  patch.frequencies = request.frequencies;
  patch.radii = request.radii;
  patch.positions = std::move(places);
  patch.positions.resize(request.radii.size()); // without the closed balls, which come last
  patch.velocities.resize(patch.size());
  patch.masses.resize(patch.size());
  patch.ids.resize(patch.size());
  std::iota(patch.ids.begin(), patch.ids.end(), std::uint64_t{0});
  parallel_for(patch.size(), [&](std::size_t k) {
    patch.velocities[k] = random_velocity(request, k);
    const double density = request.densities.empty() ? request.density : request.densities[k];
    patch.masses[k] = 4.0 / 3.0 * pi * density * std::pow(request.radii[k], 3);
  });
  if (patch.size() > 0) {
    remove_momentum(patch);
    if (request.held.empty()) // particles could be shifted into a held body
      centre_heights(patch);
  }
  follow_streamlines(request, patch);
  for (const HeldBody& body : request.held)
    add(body, patch);
  return patch;
}

} // namespace

Patch uniform_patch(const UniformRequest& request, const std::function<void(const StartProgress&)>& progress) {
  double seconds = 0.0;
  const Stopwatch watch(seconds);
  const auto show = [&](double share) {
    const double elapsed = watch.elapsed();
    if (progress)
      progress({share, elapsed, elapsed * (1.0 - share) / share});
  };
  Placing placing(request);
  placing.run(show);
  Patch patch = patch_at(request, placing.places());
  show(1.0);
  return patch;
}

} // namespace keeler
