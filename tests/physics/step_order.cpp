// The order of the kick–drift–kick step: second without collisions; with them first (rebounds.hpp derives the error);
// exact without gravity.
#include "physics/rebounds.hpp"
#include "physics/scenes.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

Scene gravity_scene(double step_orbits, int kick_every = 1, double restitution = 1.0) {
  return parse_scene(fmt::format(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [4000.0, 4000.0]
[particles]
count = 2
density = 600.0
sizes = {{ law = "equal", radius = 1.0 }}
velocity_dispersion = 5.0
[collisions]
restitution = {{ law = "constant", value = {} }}
[gravity]
solver = "direct"
images = "rings"
kick_every = {}
[time]
step = {:.17g}
end = 10.0
)",
                                 restitution, kick_every, step_orbits),
                     "test scene");
}

Patch bodies(const Scene& scene, const std::vector<Vec3>& places, const std::vector<Vec3>& velocities, double mass) {
  Patch patch;
  patch.box = {4000.0, 4000.0, scene.planet.frequencies.shear(), 0.0};
  patch.frequencies = scene.planet.frequencies;
  patch.orbital_frequency = scene.planet.orbital_frequency;
  patch.positions = places;
  patch.velocities = velocities;
  patch.radii.assign(places.size(), 1.0);
  patch.masses.assign(places.size(), mass);
  for (std::size_t k = 0; k < places.size(); ++k)
    patch.ids.push_back(k);
  return patch;
}

// Six bodies that pull hard on each other and do not meet: as heavy as 30 times their size, so that the error of the
// step stands above rounding.
Patch six_bodies(const Scene& scene) {
  std::vector<Vec3> places, velocities;
  for (int k = 0; k < 6; ++k) {
    RandomStream random(2, RandomPurpose::position, k);
    const int column = k % 3, row = k / 3;
    places.emplace_back(12.0 * column - 12.0 + random.normal(), 14.0 * row - 7.0 + random.normal(),
                        4.0 * random.normal());
    velocities.emplace_back(random.normal(), -1.5 * places.back().x() + random.normal(), random.normal());
  }
  return bodies(scene, places, velocities, 30.0 * 4.0 / 3.0 * pi * 600.0);
}

Patch evolve(const Scene& scene, const Patch& start, double orbits, std::uint64_t* collisions = nullptr) {
  Simulation simulation(scene, start);
  while (simulation.orbits() < orbits - 1e-9)
    simulation.advance();
  if (collisions)
    *collisions = simulation.state().collisions.fast + simulation.state().collisions.slow;
  return simulation.patch();
}

double distance(const Patch& a, const Patch& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += (a.positions[k] - b.positions[k]).squaredNorm();
  return std::sqrt(sum);
}

} // namespace

TEST_CASE("second order in the step without collisions, also with a kick every fourth drift") {
  constexpr double orbits = 0.256;
  std::uint64_t collisions = 0;
  const Scene fine = gravity_scene(orbits / 16384);
  const Patch reference = evolve(fine, six_bodies(fine), orbits, &collisions);
  REQUIRE(collisions == 0);
  for (const int kick_every : {1, 4}) {
    std::vector<double> errors;
    for (const int steps : {128, 256, 512, 1024}) {
      const Scene scene = gravity_scene(orbits / steps, kick_every);
      errors.push_back(distance(evolve(scene, six_bodies(scene), orbits), reference));
    }
    for (std::size_t k = 1; k < errors.size(); ++k)
      CHECK(errors[k - 1] / errors[k] == doctest::Approx(4.0).epsilon(0.1)); // 2^2, asymptotically
    MESSAGE("kick every " << kick_every << ": errors " << errors[0] << " " << errors[1] << " " << errors[2] << " "
                          << errors[3]);
  }
}

TEST_CASE("first order in the step with collisions") {
  // One sphere bounces elastically on top of another, over many phases of the bounces in the step. One start's error
  // jumps about with the phase; the root mean square over starts falls as the step.
  constexpr double orbits = 0.256;
  constexpr int starts = 60;
  const auto pair_of = [](const Scene& scene, int k) {
    const double gap = 2.05 + 0.1 * k / starts;
    return bodies(scene, {{0.0, 0.0, 0.0}, {0.0, 0.0, gap}}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}},
                  4.0 / 3.0 * pi * 600.0);
  };
  std::vector<double> errors(4, 0.0);
  for (int k = 0; k < starts; ++k) {
    std::uint64_t collisions = 0;
    const Scene fine = gravity_scene(orbits / 32768);
    const Patch reference = evolve(fine, pair_of(fine, k), orbits, &collisions);
    REQUIRE(collisions >= 1);
    for (int level = 0; level < 4; ++level) {
      const Scene scene = gravity_scene(orbits / (128 << level));
      errors[level] += std::pow(distance(evolve(scene, pair_of(scene, k), orbits), reference), 2) / starts;
    }
  }
  for (double& error : errors)
    error = std::sqrt(error);
  MESSAGE("rms errors " << errors[0] << " " << errors[1] << " " << errors[2] << " " << errors[3]);
  const double order = std::log2(errors[0] / errors[3]) / 3.0;
  CHECK(order > 0.7);
  CHECK(order < 1.4);
}

TEST_CASE("a rebound errs by (1 + ε) g h/√12, rms over the phases of the contact in the kick interval") {
  for (const double restitution : {0.2, 1.0})
    for (const double interval : {4e-3, 1e-3}) {
      const test::ReboundErrors errors = test::rebound_errors(100, interval, restitution);
      CAPTURE(restitution);
      CAPTURE(interval);
      CHECK(errors.rms == doctest::Approx(errors.law).epsilon(0.05)); // of 100 phases, and the second order
      // of either sign: the mean is that of 100 phases, and of second order
      CHECK(std::fabs(errors.mean) < (0.1 + 25.0 * interval) * errors.law);
    }
  const test::ReboundErrors drifts = test::rebound_errors(100, 4e-3, 0.5, 4); // the interval counts, not the step
  CHECK(drifts.rms == doctest::Approx(drifts.law).epsilon(0.05));
}

TEST_CASE("without gravity a step of any length is exact") {
  const Scene scene = test::spheres(0.01, 20, 1e-3, R"({ law = "constant", value = 0.5 })", 5);
  const Patch start = initial_patch(scene);
  Scene coarse = scene;
  coarse.time.step = 0.05;
  Simulation a(scene, start), b(coarse, start);
  for (int k = 0; k < 1000; ++k)
    a.advance();
  for (int k = 0; k < 20; ++k)
    b.advance();
  REQUIRE(a.state().collisions.fast == b.state().collisions.fast);
  const Patch pa = a.patch(), pb = b.patch();
  for (std::size_t k = 0; k < pa.size();
       ++k) { // the same place or an image of it: the two runs wrap at different times
    Vec3 d = pa.positions[k] - pb.positions[k];
    d += pa.box.displacement(pa.box.image_into_cell(d.x(), d.y(), pa.offset), pa.offset);
    CHECK(d.norm() < 1e-9);
  }
}
