#include <keeler/diagnostics/epicyclic_waves.hpp>

#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/diagnostics/dispersion.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace epicyclic_waves_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

const Frequencies frequencies{0.99458, 1.00539};
const ShearingBox box{600.0, 400.0, frequencies.shear(), 0.0};

double wave_number(int n) {
  return two_pi * n / box.size_x;
}

// Guiding centres at equal distances, with eccentricity vectors in a wave of `amplitude` (m) in mode `n` of one
// component and 3 of the other, a common part, and ± `random` (m) alternating, which affects only the last mode.
Particles imposed(std::size_t count, int n, double amplitude, double random) {
  Particles particles;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = box.size_x * ((static_cast<double>(k) + 0.5) / static_cast<double>(count) - 0.5);
    const double turn = k % 2 == 0 ? random : -random;
    particles.bodies.push_back({{x, 0.0, 7.0 + turn + amplitude * std::cos(wave_number(n) * x + 0.4),
                                 -4.0 + turn + amplitude * std::sin(wave_number(3) * x), 0.1, 0.2},
                                1.0,
                                5.0});
    particles.ids.push_back(k);
  }
  return particles;
}

// Random orbits and masses, and a travelling wave of two modes besides.
Particles made_up(std::size_t count, std::uint64_t seed, double amplitude) {
  Particles particles;
  RandomStream random(seed, RandomPurpose::velocity, 0);
  for (std::size_t k = 0; k < count; ++k) {
    const double x = box.size_x * (random.uniform() - 0.5), y = box.size_y * (random.uniform() - 0.5);
    const double phase = wave_number(1) * x, second = 0.3 - wave_number(2) * x;
    const double radius = 0.5 + random.uniform();
    particles.bodies.push_back({{x, y, amplitude * (std::cos(phase) + 0.5 * std::cos(second)) + 2.0 * random.normal(),
                                 amplitude * (std::sin(phase) + 0.5 * std::sin(second)) + 2.0 * random.normal(),
                                 random.normal(), random.normal()},
                                radius,
                                radius * radius * radius});
    particles.ids.push_back(k);
  }
  return particles;
}

std::optional<EpicyclicWaves> of_particles(const Particles& particles, double after) {
  return epicyclic_waves(particles, box.size_x, frequencies, after, particle_means(particles, frequencies, after));
}

std::optional<EpicyclicWaves> of_patch(const Particles& particles, double after) {
  return epicyclic_waves(make_patch(particles, box, 7.0, frequencies, after));
}

// Brute force, mode by mode and particle by particle: half of the squared amplitudes over the mean square, minus the
// expectation for random particles, 2 Σm²/(Σm)² per mode.
EpicyclicWaves by_definition(const Particles& particles, double after) {
  const Rotation rotation(frequencies, after);
  double mass = 0.0, mass_squares = 0.0, mean_x = 0.0, mean_y = 0.0;
  for (const Body& body : particles.bodies) {
    const Vec3 c = peculiar_velocity(body.elements, frequencies, rotation);
    mass += body.mass;
    mass_squares += body.mass * body.mass;
    mean_x += body.mass * c.x();
    mean_y += body.mass * c.y();
  }
  mean_x /= mass;
  mean_y /= mass;
  double xx = 0.0, yy = 0.0, waves_x = 0.0, waves_y = 0.0;
  for (int n = 0; n <= 4; ++n) {
    std::complex<double> x, y;
    for (const Body& body : particles.bodies) {
      const Vec3 c = peculiar_velocity(body.elements, frequencies, rotation);
      const double u = c.x() - mean_x, v = c.y() - mean_y, angle = wave_number(n) * body.elements.guiding_x;
      x += 2.0 * body.mass / mass * u * std::complex(std::cos(angle), -std::sin(angle));
      y += 2.0 * body.mass / mass * v * std::complex(std::cos(angle), -std::sin(angle));
      if (n == 0) {
        xx += body.mass / mass * u * u;
        yy += body.mass / mass * v * v;
      }
    }
    if (n > 0) {
      waves_x += 0.5 * std::norm(x);
      waves_y += 0.5 * std::norm(y);
    }
  }
  const double noise = 4.0 * 2.0 * mass_squares / (mass * mass), weight = 4.0 / (frequencies.kappa * frequencies.kappa);
  const auto of = [&](double waves, double all) { return (waves / all - noise) / (1.0 - noise); };
  return {of(waves_x + weight * waves_y, xx + weight * yy), of(waves_x, xx), of(waves_y, yy)};
}

void check_equal(const EpicyclicWaves& a, const EpicyclicWaves& b, double tolerance) {
  CHECK(std::fabs(a.energy - b.energy) < tolerance);
  CHECK(std::fabs(a.x - b.x) < tolerance);
  CHECK(std::fabs(a.y - b.y) < tolerance);
}

} // namespace

TEST_CASE("an imposed wave has the share of the energy that its amplitude says") {
  constexpr std::size_t count = 4096;
  const double noise = 8.0 / count;
  for (const int n : {1, 2, 3, 4, 5}) {
    // each component: ½ amplitude² of the wave and random² besides; mode 5 is not as long as the box
    const double amplitude = 3.0, random = 2.0, wave = 0.5 * amplitude * amplitude, rest = random * random;
    const double seen = (n < 5 ? 2.0 : 1.0) * wave;
    const double expected = (seen / (2.0 * (wave + rest)) - noise) / (1.0 - noise);
    CAPTURE(n);
    const Particles particles = imposed(count, n, amplitude, random);
    for (const double after : {0.0, 1.1}) {
      CHECK(of_patch(particles, after)->energy == doctest::Approx(expected).epsilon(1e-9));
      CHECK(of_particles(particles, after)->energy == doctest::Approx(expected).epsilon(1e-5));
    }
    if (n == 5)
      continue;
    const Patch patch = make_patch(particles, box, 7.0, frequencies, 0.0);
    const Vec3 dispersion = velocity_dispersion(patch),
               rest_of_it = epicyclic_waves(patch)->residual_dispersion(dispersion);
    CHECK(dispersion.x() == doctest::Approx(frequencies.kappa * std::sqrt(wave + rest)).epsilon(1e-9));
    CHECK(rest_of_it.x() == doctest::Approx(frequencies.kappa * random / std::sqrt(1.0 - noise)).epsilon(1e-9));
    CHECK(rest_of_it.y() ==
          doctest::Approx(0.5 * std::pow(frequencies.kappa, 2) * random / std::sqrt(1.0 - noise)).epsilon(1e-9));
    CHECK(rest_of_it.z() == dispersion.z());
  }
  CHECK(of_patch(imposed(count, 1, 3.0, 0.0), 0.0)->energy == doctest::Approx(1.0).epsilon(1e-12)); // nothing else
}

TEST_CASE("patch and particles give what the definition does") {
  for (const double amplitude : {0.0, 0.5, 20.0}) {
    const Particles particles = made_up(3001, 7, amplitude);
    for (const double after : {0.0, -0.01, 1.3}) {
      CAPTURE(amplitude);
      CAPTURE(after);
      const EpicyclicWaves expected = by_definition(particles, after);
      check_equal(*of_patch(particles, after), expected, 1e-11);
      // in a bin the phase of mode 4 is off by 0.028, rms: twice that in a square, at random over the particles
      check_equal(*of_particles(particles, after), expected, 0.06 / std::sqrt(3001.0));
    }
  }
}

TEST_CASE("particles at random have no waves, whatever their number") {
  for (const std::size_t count : {100, 1000}) {
    double sum = 0.0;
    constexpr int seeds = 60;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed)
      sum += of_particles(made_up(count, seed, 0.0), 0.0)->energy;
    const double scatter = 8.0 / static_cast<double>(count) / std::sqrt(8.0); // of 16 squares with a sum of 8/N
    CHECK(std::fabs(sum / seeds) < 5.0 * scatter / std::sqrt(seeds));
  }
}

TEST_CASE("neither threads nor the order in memory change a bit") {
  Particles particles = made_up(5003, 3, 1.0);
  set_threads(1);
  const EpicyclicWaves one = *of_particles(particles, -0.01);
  for (const int count : {2, 3, 8}) {
    set_threads(count);
    std::reverse(particles.bodies.begin(), particles.bodies.end());
    std::reverse(particles.ids.begin(), particles.ids.end());
    const EpicyclicWaves other = *of_particles(particles, -0.01);
    CHECK(other.energy == one.energy);
    CHECK(other.x == one.x);
    CHECK(other.y == one.y);
  }
}

TEST_CASE("too few particles, and particles on circles, have no waves to speak of") {
  CHECK_FALSE(of_particles(made_up(10, 1, 1.0), 0.0));
  CHECK_FALSE(of_patch(made_up(10, 1, 1.0), 0.0));
  CHECK(of_patch(made_up(100, 1, 1.0), 0.0));
  CHECK_FALSE(of_particles({}, 0.0));
  Particles circles = made_up(100, 1, 1.0);
  for (Body& body : circles.bodies)
    body.elements = {body.elements.guiding_x, 0.0, 0.0, 0.0, 0.0, 0.0};
  CHECK_FALSE(of_particles(circles, 0.0));
}

} // namespace epicyclic_waves_test
