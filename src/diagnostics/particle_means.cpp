#include <keeler/diagnostics/particle_means.hpp>

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

struct Sums {
  double mass = 0.0, energy = 0.0, azimuthal = 0.0, product = 0.0, heights = 0.0;
  Vec3 velocities = Vec3::Zero(), squares = Vec3::Zero();

  Sums& operator+=(const Sums& more) {
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
  double mass = 0.0, inertia = 0.0, energy = 0.0, squares = 0.0;
  Vec3 spins = Vec3::Zero(), moments = Vec3::Zero(); // Σ m ω, Σ I ω

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

SpinMeans spin_means(const Particles& particles, double after) {
  if (!particles.rough)
    return {};
  const SpinTurn turn(after);
  const SpinSums sums = ordered_total<SpinSums>(particles.size(), [&](SpinSums& total, std::size_t k) {
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
  const Vec3 mean = sums.spins / sums.mass, frame(0.0, 0.0, 1.0);
  const auto energy_about = [&](const Vec3& spin) { // Σ ½ I (ω − spin)²
    return sums.energy - sums.moments.dot(spin) + 0.5 * sums.inertia * spin.squaredNorm();
  };
  return {energy_about(frame), energy_about(mean), mean,
          std::sqrt(std::max(0.0, sums.squares / sums.mass - mean.squaredNorm()))};
}

} // namespace

// Variances in one pass: squares are taken about the velocity of one of the particles, so that a common motion of all
// does not cancel digits.
ParticleMeans particle_means(const Particles& particles, const Frequencies& frequencies, double after) {
  if (particles.size() == 0)
    return {};
  const Rotation rotation(frequencies, after);
  const Vec3 near = peculiar_velocity(particles.bodies[0].elements, frequencies, rotation);
  const Sums sums = ordered_total<Sums>(particles.size(), [&](Sums& total, std::size_t k) {
    particles.prefetch_after(k);
    const Body& body = particles.bodies[k];
    const Elements& el = body.elements;
    const Vec3 c = peculiar_velocity(el, frequencies, rotation), v = c - near, momentum = body.mass * v;
    const double height = el.i_sin * rotation.cos_i + el.i_cos * rotation.sin_i;
    total.mass += body.mass;
    total.energy += body.mass * epicyclic_energy(el, frequencies);
    total.azimuthal += body.mass * c.y() * c.y();
    total.product += momentum.x() * v.y();
    total.heights += body.mass * height * height;
    total.velocities += momentum;
    total.squares += momentum.cwiseProduct(v);
  });
  const Vec3 mean = sums.velocities / sums.mass;
  const Vec3 variance = (sums.squares / sums.mass - mean.cwiseProduct(mean)).cwiseMax(0.0); // not below by rounding
  return {sums.mass,
          sums.energy,
          sums.azimuthal,
          variance.cwiseSqrt(),
          sums.product / sums.mass - mean.x() * mean.y(),
          std::sqrt(sums.heights / sums.mass),
          spin_means(particles, after)};
}

} // namespace keeler
