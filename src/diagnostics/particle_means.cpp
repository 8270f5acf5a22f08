#include <keeler/diagnostics/particle_means.hpp>

#include <keeler/core/exact_sum.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace keeler::diagnostics {
namespace {

struct PatchSums {
  ExactSum mass, energy, azimuthal, product, heights;
  ExactVec3 velocities, squares;

  PatchSums& operator+=(const PatchSums& more) {
    mass += more.mass;
    energy += more.energy;
    azimuthal += more.azimuthal;
    product += more.product;
    heights += more.heights;
    velocities += more.velocities;
    squares += more.squares;
    return *this;
  }
};

struct SpinSums {
  ExactSum mass, inertia, energy, squares;
  ExactVec3 spins, moments; // Σ m ω, Σ I ω

  SpinSums& operator+=(const SpinSums& more) {
    mass += more.mass;
    inertia += more.inertia;
    energy += more.energy;
    squares += more.squares;
    spins += more.spins;
    moments += more.moments;
    return *this;
  }
};

SpinMeans spin_means(const Particles& particles, double after, const Communicator& ranks) {
  if (!particles.rough)
    return {};
  const particles::SpinTurn turn(after);
  SpinSums sums = exact_total<SpinSums>(particles.size(), [&](SpinSums& total, std::size_t k) {
    const Body& body = particles.bodies[k];
    const double inertia = 0.4 * body.mass * body.radius * body.radius;
    const Vec3 spin = turn.from_epoch(particles.spins[k]);
    total.mass += body.mass;
    total.inertia += inertia;
    total.energy += 0.5 * inertia * spin.squaredNorm();
    total.squares += body.mass * spin.squaredNorm();
    total.spins += body.mass * spin;
    total.moments += inertia * spin;
  });
  ranks.merge({&sums.mass, &sums.inertia, &sums.energy, &sums.squares, &sums.spins.x, &sums.spins.y, &sums.spins.z,
               &sums.moments.x, &sums.moments.y, &sums.moments.z});
  const double mass = sums.mass.value();
  const Vec3 mean = sums.spins.value() / mass, frame(0.0, 0.0, 1.0), moments = sums.moments.value();
  const auto energy_about = [&](const Vec3& spin) { // Σ ½ I (ω − spin)²
    return sums.energy.value() - moments.dot(spin) + 0.5 * sums.inertia.value() * spin.squaredNorm();
  };
  return {energy_about(frame), energy_about(mean), mean,
          std::sqrt(std::max(0.0, sums.squares.value() / mass - mean.squaredNorm()))};
}

// Returns the velocity of the particle with the smallest id, on all ranks.
Vec3 one_velocity(const Particles& particles, const Frequencies& frequencies, const Rotation& rotation,
                  const Communicator& ranks) {
  struct One {
    std::uint64_t id = std::numeric_limits<std::uint64_t>::max();
    double x = 0.0, y = 0.0, z = 0.0;
  } one;
  const auto first = std::min_element(particles.ids.begin(), particles.ids.end());
  if (first != particles.ids.end()) {
    const std::size_t k = static_cast<std::size_t>(first - particles.ids.begin());
    const Vec3 c = peculiar_velocity(particles.bodies[k].elements, frequencies, rotation);
    one = {*first, c.x(), c.y(), c.z()};
  }
  for (const std::vector<One>& other : ranks.exchange(std::vector(ranks.size(), std::vector{one})))
    if (other.front().id < one.id)
      one = other.front();
  return {one.x, one.y, one.z};
}

} // namespace

// Computes variances in one pass: squares are taken relative to the velocity of one of the particles, so that a common
// motion of all does not cancel digits.
ParticleMeans particle_means(const Particles& particles, const Frequencies& frequencies, double after,
                             const Communicator& ranks) {
  if (particles.size() == 0 && !ranks.distributed())
    return {};
  assert(particles.ids.size() == particles.size());
  const Rotation rotation(frequencies, after);
  const Vec3 reference = one_velocity(particles, frequencies, rotation, ranks);
  PatchSums sums = exact_total<PatchSums>(particles.size(), [&](PatchSums& total, std::size_t k) {
    particles.prefetch_after(k);
    const Body& body = particles.bodies[k];
    const Elements& el = body.elements;
    const Vec3 c = peculiar_velocity(el, frequencies, rotation), v = c - reference, momentum = body.mass * v;
    const double height = el.i_sin * rotation.cos_i + el.i_cos * rotation.sin_i;
    total.mass += body.mass;
    total.energy += body.mass * epicyclic_energy(el, frequencies);
    total.azimuthal += body.mass * c.y() * c.y();
    total.product += momentum.x() * v.y();
    total.heights += body.mass * height * height;
    total.velocities += momentum;
    total.squares += momentum.cwiseProduct(v);
  });
  ranks.merge({&sums.mass, &sums.energy, &sums.azimuthal, &sums.product, &sums.heights, &sums.velocities.x,
               &sums.velocities.y, &sums.velocities.z, &sums.squares.x, &sums.squares.y, &sums.squares.z});
  const double mass = sums.mass.value();
  const Vec3 mean = sums.velocities.value() / mass;
  const Vec3 variance = (sums.squares.value() / mass - mean.cwiseProduct(mean)).cwiseMax(0.0); // not below by rounding
  return {mass,
          sums.energy.value(),
          sums.azimuthal.value(),
          variance.cwiseSqrt(),
          sums.product.value() / mass - mean.x() * mean.y(),
          std::sqrt(sums.heights.value() / mass),
          spin_means(particles, after, ranks),
          reference + mean};
}

} // namespace keeler::diagnostics
