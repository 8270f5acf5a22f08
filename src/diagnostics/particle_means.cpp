#include <keeler/diagnostics/particle_means.hpp>

#include <keeler/core/threads.hpp>

#include <cmath>

namespace keeler {
namespace {

struct Sums {
  double mass = 0.0, energy = 0.0, heights = 0.0;
  Vec3 velocities = Vec3::Zero(), squares = Vec3::Zero();

  Sums& operator+=(const Sums& more) {
    mass += more.mass;
    energy += more.energy;
    heights += more.heights;
    velocities += more.velocities;
    squares += more.squares;
    return *this;
  }
};

// The height of a particle, and its velocity beyond the shear at its own place: (2 − S) e cos φ = ½κ² e cos φ along y.
struct Motion {
  double height;
  Vec3 velocity;

  Motion(const Elements& el, const Frequencies& f, const Rotation& r)
      : height(el.i_sin * r.cos_i + el.i_cos * r.sin_i),
        velocity(f.kappa * (el.e_sin * r.cos_e + el.e_cos * r.sin_e),
                 0.5 * f.kappa * f.kappa * (el.e_cos * r.cos_e - el.e_sin * r.sin_e),
                 f.nu * (el.i_cos * r.cos_i - el.i_sin * r.sin_i)) {}
};

} // namespace

// Variances in one pass: squares are taken about the velocity of one of the particles, so that a common motion of all
// does not cancel digits.
ParticleMeans particle_means(const Particles& particles, const Frequencies& frequencies, double after) {
  if (particles.size() == 0)
    return {};
  const Rotation rotation(frequencies, after);
  const Vec3 near = Motion(particles.bodies[0].elements, frequencies, rotation).velocity;
  const Sums sums = ordered_total<Sums>(particles.size(), [&](Sums& total, std::size_t k) {
    particles.prefetch_after(k);
    const Body& body = particles.bodies[k];
    const Motion motion(body.elements, frequencies, rotation);
    const Vec3 v = motion.velocity - near, momentum = body.mass * v;
    total.mass += body.mass;
    total.energy += body.mass * energy(body.elements, frequencies);
    total.heights += body.mass * motion.height * motion.height;
    total.velocities += momentum;
    total.squares += momentum.cwiseProduct(v);
  });
  const Vec3 mean = sums.velocities / sums.mass;
  const Vec3 variance = (sums.squares / sums.mass - mean.cwiseProduct(mean)).cwiseMax(0.0); // not below by rounding
  return {sums.mass, sums.energy, variance.cwiseSqrt(), std::sqrt(sums.heights / sums.mass)};
}

} // namespace keeler
