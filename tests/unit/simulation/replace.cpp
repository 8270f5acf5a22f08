// A state changed from outside while it runs.
#include <keeler/core/error.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <cstring>

namespace replace_test {

using namespace keeler;
using namespace keeler::simulation;

namespace {

Scene ring(const std::string& more = {}) {
  return parse_scene(R"(
    planet.preset = "saturn-a-ring"
    box.size = [60.0, 60.0]
    particles = { optical_depth = 0.3, density = 450.0, sizes = { law = "equal", radius = 1.0 } }
    gravity = { solver = "tree", kick_every = 2 }
    time = { step = 2e-3, end = 1.0 }
  )" + more,
                     "test scene");
}

bool same_bits(const Particles& a, const Particles& b) {
  return a.ids == b.ids && std::memcmp(a.bodies.data(), b.bodies.data(), a.bodies.size() * sizeof(Body)) == 0;
}

void steps(Simulation& simulation, int count) {
  for (int k = 0; k < count; ++k)
    simulation.advance();
}

} // namespace

TEST_CASE("a state replaced by itself goes on to the bit") {
  const Scene scene = ring();
  Simulation simulation(scene, initial_patch(scene)), untouched(scene, initial_patch(scene));
  steps(simulation, 60), steps(untouched, 60);
  simulation.replace(simulation.state().particles);
  steps(simulation, 60), steps(untouched, 60);
  CHECK(same_bits(simulation.state().particles, untouched.state().particles));
}

TEST_CASE("what a change brings is in the balance of energy as part of the start") {
  const Scene scene = ring();
  Simulation simulation(scene, initial_patch(scene));
  steps(simulation, 20);
  const EnergyBalance before = simulation.balance();
  Particles faster = simulation.state().particles;
  double gain = 0.0;
  for (Body& body : faster.bodies) {
    const double old = epicyclic_energy(body.elements, scene.planet.frequencies);
    body.elements.i_cos *= 1.05;
    gain += body.mass * (epicyclic_energy(body.elements, scene.planet.frequencies) - old);
  }
  REQUIRE(std::abs(gain) > 1e-4 * before.energy);
  simulation.replace(faster);
  steps(simulation, 20);
  const EnergyBalance after = simulation.balance();
  CHECK(std::abs(after.start - before.start - gain) < 1e-12 * before.energy);
  // the budget closes to rounding, as it did before
  CHECK(std::abs(after.residual) < 1e-11 * after.energy);
}

TEST_CASE("a state that cannot be is refused, and nothing has changed") {
  const Scene scene = ring();
  Simulation simulation(scene, initial_patch(scene)), untouched(scene, initial_patch(scene));
  Particles overlapping = simulation.state().particles, endless = overlapping;
  overlapping.bodies[0].elements = overlapping.bodies[1].elements;
  endless.bodies[7].elements.e_cos = std::nan("");
  CHECK_THROWS_AS(simulation.replace(overlapping), InvariantError);
  CHECK_THROWS_AS(simulation.replace(endless), InvariantError);
  steps(simulation, 10), steps(untouched, 10);
  CHECK(same_bits(simulation.state().particles, untouched.state().particles));
}

} // namespace replace_test
