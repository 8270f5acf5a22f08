#include <keeler/diagnostics/particle_means.hpp>

#include "spin.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/diagnostics/dispersion.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>

namespace particle_means_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

const Frequencies frequencies{0.99458, 1.00539};
const ShearingBox box{600.0, 400.0, frequencies.shear(), 0.0};

// Random orbits and masses; all move together with `common` (m of e sin, e cos, i cos) besides.
Particles made_up(std::size_t count, const Vec3& common) {
  Particles particles;
  RandomStream random(1, RandomPurpose::velocity, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const Elements el{600.0 * (random.uniform() - 0.5),   400.0 * (random.uniform() - 0.5),
                      2.0 * random.normal() + common.y(), 2.0 * random.normal() + common.x(),
                      1.5 * random.normal() + common.z(), 1.5 * random.normal()};
    const double radius = 0.2 + random.uniform();
    particles.bodies.push_back({el, radius, radius * radius * radius});
    particles.ids.push_back(count - k);
  }
  return particles;
}

void check_against_patch(const Particles& particles, double after) {
  const Patch patch = make_patch(particles, box, 7.0, frequencies, after);
  const ParticleMeans means = particle_means(particles, frequencies, after);
  const Vec3 expected = velocity_dispersion(patch);
  CAPTURE(after);
  CHECK((means.dispersion - expected).norm() < 1e-12 * expected.norm());
  CHECK(means.scale_height == doctest::Approx(scale_height(patch)).epsilon(1e-13));
}

} // namespace

TEST_CASE("one pass over the elements gives the numbers of the patch") {
  const Particles particles = made_up(5003, Vec3::Zero());
  for (const double after : {0.0, -0.01, 1.3})
    check_against_patch(particles, after);
}

TEST_CASE("one pass over the spins gives the numbers of the patch") {
  Particles particles = made_up(2003, Vec3::Zero());
  CHECK(particle_means(particles, frequencies, 0.3).spin.energy == 0.0); // smooth ones
  particles.rough = true;
  RandomStream random(2, RandomPurpose::velocity, 0);
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const double x = random.normal(), y = random.normal(), z = 0.3 + random.normal();
    particles.spins.emplace_back(x, y, z);
  }
  const Patch patch = make_patch(particles, box, 7.0, frequencies, 0.3);
  const SpinState state = spin_state(patch).value();
  const ParticleMeans means = particle_means(particles, frequencies, 0.3);
  CHECK((means.spin.mean - state.mean).norm() < 1e-13);
  CHECK(means.spin.dispersion == doctest::Approx(state.dispersion).epsilon(1e-13));
  const double motion = 0.5 * means.mass * means.dispersion.squaredNorm();
  CHECK(means.spin.random_energy / motion == doctest::Approx(state.energy_ratio).epsilon(1e-12));
  double energy = 0.0;
  for (std::size_t k = 0; k < patch.size(); ++k)
    energy += 0.2 * patch.masses[k] * std::pow(patch.radii[k], 2) * (patch.spins[k] - Vec3::UnitZ()).squaredNorm();
  CHECK(means.spin.energy == doctest::Approx(energy).epsilon(1e-12));
  // a vector fixed among the stars rotates backwards in Hill's frame
  CHECK((patch.spins[0] - Eigen::AngleAxisd(-0.3, Vec3::UnitZ()) * particles.spins[particles.size() - 1]).norm() <
        1e-14);
  const Particles back = particles_from(patch, -0.3);
  CHECK((back.spins[0] - particles.spins[particles.size() - 1]).norm() < 1e-14);
}

TEST_CASE("a common motion, however large, costs no digits of the dispersion") {
  // a thousand times the dispersion: a variance as a difference of squares about zero would keep ten digits
  check_against_patch(made_up(5003, Vec3(3e3, -2e3, 1e3)), -0.01);
}

TEST_CASE("mass and energy are the plain sums, in blocks that no number of threads changes") {
  const Particles particles = made_up(5003, Vec3::Zero());
  set_threads(1);
  const ParticleMeans one = particle_means(particles, frequencies, -0.01);
  double mass = 0.0, sum = 0.0;
  for (const Body& body : particles.bodies) {
    mass += body.mass;
    sum += body.mass * epicyclic_energy(body.elements, frequencies);
  }
  CHECK(one.mass == doctest::Approx(mass).epsilon(1e-13));
  CHECK(one.epicyclic_energy == doctest::Approx(sum).epsilon(1e-12));
  for (const int count : {2, 3, 8}) {
    set_threads(count);
    const ParticleMeans several = particle_means(particles, frequencies, -0.01);
    CHECK(several.mass == one.mass);
    CHECK(several.epicyclic_energy == one.epicyclic_energy);
    CHECK(several.azimuthal == one.azimuthal);
    CHECK(several.random_stress == one.random_stress);
    CHECK(several.dispersion == one.dispersion);
    CHECK(several.scale_height == one.scale_height);
  }
}

TEST_CASE("without particles all means are zero") {
  const ParticleMeans none = particle_means({}, frequencies, 0.0);
  CHECK(none.mass == 0.0);
  CHECK(none.dispersion == Vec3(0.0, 0.0, 0.0));
}

} // namespace particle_means_test
