// The order of the kick–drift–kick step: second, also with collisions (rebounds.hpp); exact without gravity.
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

TEST_CASE("second order in the step with collisions") {
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
    const Scene fine = gravity_scene(orbits / 16384);
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
  CHECK(order > 1.6);
  CHECK(order < 2.4);
}

TEST_CASE("the speed of a rebound is of second order, whatever the phase of its contact in the kick interval") {
  for (const double restitution : {0.2, 1.0})
    for (const int kick_every : {1, 4}) { // the interval counts, not the step
      const test::ReboundErrors coarse = test::rebound_errors(100, 4e-3, restitution, kick_every),
                                fine = test::rebound_errors(100, 1e-3, restitution, kick_every);
      MESSAGE("restitution " << restitution << ": rms errors " << coarse.rms << " and " << fine.rms << " rΩ");
      CHECK(coarse.rms / fine.rms > 12.0); // 4², asymptotically
      CHECK(coarse.rms < 0.1 * coarse.of_drift);
    }
}

TEST_CASE("a pair at rest that bounces at each kick loses nothing in the mean") {
  constexpr double interval = 4e-3, mass = 4.0 / 3.0 * pi * 600.0; // orbits, kg
  const Scene scene = gravity_scene(interval, 1, 0.5);
  Simulation simulation(scene, bodies(scene, {{0.0, 0.0, 0.0}, {0.0, 0.0, 2.01}}, {Vec3::Zero(), Vec3::Zero()}, mass));
  const auto lost_until = [&](double orbits) {
    while (simulation.orbits() < orbits - 1e-9)
      simulation.advance();
    return simulation.balance().lost;
  };
  const double before = lost_until(0.4), lost = lost_until(1.2) - before, kicks = 0.8 / interval;
  const double kick = newton_g(scene.planet.orbital_frequency) * 2.0 * mass / 4.0 * two_pi * interval;
  MESSAGE("lost per kick, over m/2 times the square of its speed: " << lost / kicks / (0.5 * mass * kick * kick));
  CHECK(simulation.state().collisions.unresolved > 100);
  // a fifth of that is what kicks give to the contacts
  CHECK(std::fabs(lost) / kicks < 0.01 * 0.5 * mass * kick * kick);
  CHECK(std::fabs(simulation.balance().residual) < 1e-9 * mass * kick * kick);
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
