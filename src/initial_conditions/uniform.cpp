#include <keeler/initial_conditions/uniform.hpp>

#include "placing.hpp"

#include <keeler/core/exact_sum.hpp>
#include <keeler/core/parallel.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/core/units.hpp>

#include <cassert>
#include <cmath>

namespace keeler::initial_conditions {
namespace {

// Draws an epicycle of random phase: its whole horizontal velocity, but vertically only half, as z has the other half.
Vec3 random_velocity(const UniformRequest& request, std::size_t k) {
  RandomStream random(request.seed, RandomPurpose::velocity, k);
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {request.dispersion_x * x, 0.5 * request.frequencies.kappa * request.dispersion_x * y,
          request.dispersion_z * z};
}

// Removes the momentum by the smallest change in the sum of squares: in proportion to the mass, so that one heavy
// particle does not make the light ones drift.
void remove_momentum(Patch& patch, const Communicator& ranks) {
  auto squares = exact_total<ExactSum>(patch.size(),
                                       [&](ExactSum& sum, std::size_t k) { sum += patch.masses[k] * patch.masses[k]; });
  auto momentum = exact_total<ExactVec3>(
      patch.size(), [&](ExactVec3& sum, std::size_t k) { sum += patch.masses[k] * patch.velocities[k]; });
  ranks.merge({&squares, &momentum.x, &momentum.y, &momentum.z});
  const Vec3 change = momentum.value() / squares.value();
  parallel_for(patch.size(), [&](std::size_t k) { patch.velocities[k] -= patch.masses[k] * change; });
}

void centre_heights(Patch& patch, const Communicator& ranks) {
  auto mass = exact_total<ExactSum>(patch.size(), [&](ExactSum& sum, std::size_t k) { sum += patch.masses[k]; });
  auto moment = exact_total<ExactSum>(
      patch.size(), [&](ExactSum& sum, std::size_t k) { sum += patch.masses[k] * patch.positions[k].z(); });
  ranks.merge({&mass, &moment});
  const double height = moment.value() / mass.value();
  parallel_for(patch.size(), [&](std::size_t k) { patch.positions[k].z() -= height; });
}

void follow_streamlines(const UniformRequest& request, Patch& patch) {
  parallel_for(patch.size(), [&](std::size_t k) {
    const double guiding_x = request.streamlines.guiding_x(patch.positions[k].x());
    patch.velocities[k] += state_at(request.streamlines.elements(guiding_x), request.frequencies, Rotation()).velocity;
  });
}

Patch patch_of(const UniformRequest& request, const std::vector<Sphere>& particles, const Communicator& ranks) {
  Patch patch;
  patch.box = request.box;
  patch.offset = request.box.first_offset;
  patch.frequencies = request.frequencies;
  patch.positions.resize(particles.size());
  patch.velocities.resize(particles.size());
  patch.radii.resize(particles.size());
  patch.masses.resize(particles.size());
  patch.ids.resize(particles.size());
  parallel_for(particles.size(), [&](std::size_t k) {
    const Sphere& sphere = particles[k];
    patch.ids[k] = sphere.particle;
    patch.positions[k] = sphere.position;
    patch.velocities[k] = random_velocity(request, sphere.particle);
    patch.radii[k] = sphere.radius;
    const double density = request.density_of ? request.density_of(sphere.particle) : request.density;
    patch.masses[k] = 4.0 / 3.0 * pi * density * std::pow(sphere.radius, 3);
  });
  std::uint64_t next_id = ranks.sum(patch.size());
  if (next_id > 0) {
    remove_momentum(patch, ranks);
    if (request.closed.empty()) // particles could be shifted into a held body
      centre_heights(patch, ranks);
  }
  follow_streamlines(request, patch);
  for (const HeldBody& body : request.held)
    body.add_to(patch, next_id++);
  return patch;
}

} // namespace

void HeldBody::add_to(Patch& patch, std::uint64_t id) const {
  patch.positions.push_back(position);
  patch.velocities.push_back(velocity);
  patch.radii.push_back(radius);
  patch.masses.push_back(mass);
  patch.ids.push_back(id);
}

Patch uniform_patch(const UniformRequest& request, const std::function<void(const StartProgress&)>& progress,
                    const Communicator& ranks) {
  assert(request.box.area() > 0.0 && request.frequencies.nu > 0.0);
  assert(request.density > 0.0 && request.dispersion_x >= 0.0 && request.dispersion_z >= 0.0);
  double seconds = 0.0;
  const Stopwatch watch(seconds);
  const auto show = [&](double fraction) {
    assert(fraction > 0.0);
    const double elapsed = watch.elapsed();
    if (progress)
      progress({fraction, elapsed, elapsed * (1.0 - fraction) / fraction});
  };
  Placing placing(request, ranks);
  placing.run(show);
  Patch patch = patch_of(request, placing.take_particles(), ranks);
  show(1.0);
  return patch;
}

} // namespace keeler::initial_conditions
