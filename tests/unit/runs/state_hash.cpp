#include <keeler/runs/state_hash.hpp>

#include "scenes.hpp"

#include <keeler/simulation/simulation.hpp>
#include <keeler/states/initial.hpp>

#include <doctest/doctest.h>

#include <algorithm>

using namespace keeler;
using namespace keeler::test;

namespace {

SimulationState evolved(const Scene& scene, int steps) {
  Simulation simulation(scene, initial_patch(scene));
  for (int k = 0; k < steps; ++k)
    simulation.advance();
  return simulation.state();
}

} // namespace

TEST_CASE("the hash sees the state and the physics, not memory order, schedules or counters") {
  const Scene scene = small_scene();
  const SimulationState state = evolved(scene, 5);
  const std::string hash = state_hash(state, scene);
  CHECK(hash.size() == 32);

  SimulationState reversed = state;
  std::reverse(reversed.particles.bodies.begin(), reversed.particles.bodies.end());
  std::reverse(reversed.particles.ids.begin(), reversed.particles.ids.end());
  reversed.collisions.fast += 7;
  Scene later = scene;
  later.time.end_step *= 2;
  later.output.snapshot_every += 1;
  later.title = "another";
  CHECK(state_hash(reversed, later) == hash);

  SimulationState moved = state;
  moved.particles.bodies[3].elements.e_cos = std::nextafter(moved.particles.bodies[3].elements.e_cos, 1.0);
  CHECK(state_hash(moved, scene) != hash);
  SimulationState stepped = state;
  ++stepped.step;
  CHECK(state_hash(stepped, scene) != hash);
  Scene other = scene;
  other.gravity->opening_angle = 0.5;
  CHECK(state_hash(state, other) != hash);
  other = scene;
  other.collisions.finder = "linear-full";
  CHECK(state_hash(state, other) != hash);
}

TEST_CASE("the field table holds all that a run needs to go on to the bit") {
  const Scene scene = small_scene();
  SimulationState half = evolved(scene, 10);
  SimulationState restored; // filled through the table alone, as a checkpoint is read
  FieldTable from = half.fields(), into = restored.fields();
  for (std::size_t k = 0; k < from.fields().size(); ++k) {
    const Field &source = from.fields()[k], &target = into.fields()[k];
    target.resize(source.rows());
    std::copy_n(static_cast<const char*>(source.data()), source.bytes(), static_cast<char*>(target.data()));
  }
  Simulation resumed(scene, restored);
  for (int k = 0; k < 10; ++k)
    resumed.advance();
  const SimulationState straight = evolved(scene, 20);
  CHECK(state_hash(resumed.state(), scene) == state_hash(straight, scene));
  CHECK(resumed.state().collisions.fast == straight.collisions.fast);
  CHECK(resumed.state().energy.kick_work == straight.energy.kick_work);
}
