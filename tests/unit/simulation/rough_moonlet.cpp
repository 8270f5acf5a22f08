// Friction and [[moonlet]] in one scene: the torque of a contact, and identical bits for any number of threads.
#include "draws.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>

namespace rough_moonlet_test {

using namespace keeler;

namespace {

const std::string rough = "[collisions]\nfriction = { tangential_restitution = 0.3, coefficient = 0.5 }\n"
                          "restitution = { law = \"constant\", value = 0.6 }\n";

// A grain and a moonlet in the plane at one instant.
struct Couple {
  State grain, moonlet;

  double distance() const { return (moonlet.position - grain.position).norm(); }
};

Couple couple_at(const Patch& patch, double after) {
  const auto state = [&](std::size_t k) {
    const Elements el = elements_from({patch.positions[k], patch.velocities[k]}, patch.frequencies, Rotation());
    return state_at(el, patch.frequencies, Rotation(patch.frequencies, after));
  };
  return {state(0), state(1)};
}

double inertia(const Patch& patch, std::size_t k) {
  return 0.4 * patch.masses[k] * patch.radii[k] * patch.radii[k];
}

// Angular momentum about the vertical through the origin, of motion in Hill's frame and spins.
double angular_momentum(const Patch& patch, const Couple& at) {
  const auto orbital = [](const State& s) { return s.position.cross(s.velocity).z(); };
  double sum = patch.masses[0] * orbital(at.grain) + patch.masses[1] * orbital(at.moonlet);
  for (const std::size_t k : {0u, 1u})
    sum += inertia(patch, k) * patch.spins[k].z();
  return sum;
}

} // namespace

// At the instant of the contact: before and after it motion is free, so both are known there from a patch at rest or a
// patch at the end of the step. Spins about the vertical do not change between contacts.
TEST_CASE("a contact with a rough moonlet keeps angular momentum, and turns grain and moonlet by the same torque") {
  const Scene scene = parse_scene("planet.orbital_frequency = 2e-4\nbox.size = [1000.0, 1000.0]\n"
                                  "particles = { count = 1, density = 900.0, sizes = { law = \"equal\", radius = 1.0 } "
                                  "}\ntime = { step = 2e-3, end = 1.0 }\n[[moonlet]]\nradius = 5.0\ndensity = 450.0\n" +
                                      rough,
                                  "test scene");
  Patch start = initial_patch(scene);
  start.positions = {Vec3(-5.0, -4.0, 0.0), Vec3::Zero()};
  start.velocities = {Vec3(60.0, 25.0, 0.0), Vec3::Zero()};
  start.spins = {Vec3(0.0, 0.0, 3.0), Vec3(0.0, 0.0, 0.5)};
  Simulation simulation(scene, start);
  simulation.advance();
  REQUIRE(simulation.state().collisions.fast == 1);
  const Patch end = simulation.patch();
  double low = 0.0, high = simulation.state().step_length; // of the contact, by bisection
  REQUIRE(couple_at(start, low).distance() > 6.0);
  REQUIRE(couple_at(start, high).distance() < 6.0);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (couple_at(start, middle).distance() > 6.0 ? low : high) = middle;
  }
  const Couple before = couple_at(start, low), after = couple_at(end, low - simulation.state().step_length);
  CHECK((after.grain.position - before.grain.position).norm() < 1e-9);
  CHECK((after.moonlet.position - before.moonlet.position).norm() < 1e-9);
  const double torque_of_grain = inertia(start, 0) * (end.spins[0].z() - start.spins[0].z()),
               torque_of_moonlet = inertia(start, 1) * (end.spins[1].z() - start.spins[1].z());
  CHECK(std::fabs(torque_of_grain) > 1.0);
  CHECK(torque_of_grain / start.radii[0] == doctest::Approx(torque_of_moonlet / start.radii[1]).epsilon(1e-9));
  const double gained = angular_momentum(end, after) - angular_momentum(start, before);
  CHECK(std::fabs(gained) < 1e-9 * std::fabs(torque_of_moonlet));
}

TEST_CASE("a rough ring around moonlets has the same bits for 1 to 3 threads, spins included") {
  const Scene scene = parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [60.0, 60.0]\n"
                                  "particles = { optical_depth = 0.5, density = 900.0, sizes = { law = \"power\", "
                                  "exponent = 3.0, min = 0.4, max = 1.5 } }\n"
                                  "gravity.solver = \"tree\"\ntime = { step = 2e-3, end = 1.0 }\n"
                                  "[[moonlet]]\nradius = 8.0\ndensity = 450.0\nposition = [26, 3, 0]\n"
                                  "[[moonlet]]\nradius = 3.0\ndensity = 900.0\nposition = [-10, 0, 0]\n" +
                                      rough,
                                  "test scene");
  const Patch start = initial_patch(scene);
  const auto end = [&](int count) {
    set_threads(count);
    Simulation simulation(scene, start);
    for (std::uint64_t k = 0; k < test::draws(100); ++k)
      simulation.advance();
    return simulation.patch();
  };
  const int before = threads();
  const Patch one = end(1);
  CHECK(one.spins.back().norm() > 0.0);
  for (const int count : {2, 3}) {
    const Patch several = end(count);
    CHECK(several.positions == one.positions);
    CHECK(several.velocities == one.velocities);
    CHECK(several.spins == one.spins);
  }
  set_threads(before);
}

} // namespace rough_moonlet_test
