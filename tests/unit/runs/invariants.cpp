// The checks of `keeler run --check`: none fails in correct runs of all kinds, and each fails on a state that violates
// its invariant.
#include "invariants.hpp"
#include "reference_forces.hpp"
#include "step_check.hpp"

#include "scenes.hpp"

#include <keeler/initial_conditions/initial.hpp>
#include <keeler/runs/state_hash.hpp>

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace invariants_test {

using namespace keeler;
using namespace keeler::runs;
using namespace keeler::test;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// A simulation after some steps, with the state before its last step.
struct Stepped {
  Scene scene;
  Simulation simulation;
  BeforeStep before;

  explicit Stepped(const std::vector<std::string>& overrides = {})
      : scene(small_scene(overrides)), simulation(scene, initial_patch(scene)) {
    for (int k = 0; k < 20; ++k)
      simulation.advance();
    before = before_step(simulation);
    simulation.advance();
  }

  const Frequencies& frequencies() const { return scene.planet.frequencies; }
  diagnostics::ParticleMeans means_of(const simulation::SimulationState& state) const {
    return diagnostics::particle_means(state.particles, frequencies(), -0.5 * state.step_length);
  }
  std::string sums(const simulation::SimulationState& state) const {
    return fault_of_sums(before, state, frequencies());
  }
  std::string energy(const simulation::SimulationState& state) const {
    return fault_of_energy(before, state, means_of(state), frequencies());
  }
};

const std::vector<std::vector<std::string>> kinds = {
    {},
    {"gravity.solver=fft", "gravity.kick_every=5"},
    {"gravity.solver=direct", "box.size=[24.0,37.0]"},
    {"gravity.solver=direct", "gravity.images=rings", "gravity.image_rings=1"},
    {"gravity.solver=tree", "gravity.opening_angle=0.8", "time.step=\"auto\""},
    {"gravity.solver=axisymmetric", "gravity.shortest_wavelength=5.0"},
    {"collisions.friction.tangential_restitution=0.6", "planet.epicyclic_ratio=0.9", "planet.vertical_ratio=2.0"},
    {"constant_acceleration.azimuthal=1e-9", "time.step=0.02"},
    {"particles.velocity_dispersion=20.0", "box.size=[60.0,15.0]"},
};

} // namespace

TEST_CASE("all invariants hold at each step of sound runs, and to look at them changes no bit") {
  std::uint64_t contacts = 0;
  for (const std::vector<std::string>& kind : kinds) {
    const Scene scene = small_scene(kind);
    CAPTURE(scene.resolved);
    Simulation checked(scene, initial_patch(scene)), plain(scene, initial_patch(scene));
    {
      StepCheck check(scene, checked);
      for (int k = 0; k < 20; ++k) {
        check.begin();
        checked.advance();
        CHECK_NOTHROW(check.end());
        plain.advance();
      }
    }
    const simulation::SimulationState& state = checked.state();
    contacts += state.collisions.fast + state.collisions.slow;
    CHECK(state_hash(state, scene) == state_hash(plain.state(), scene));
    CHECK(fault_of_budget(state, checked.means(), scene.planet.frequencies).empty());
  }
  CHECK(contacts > 100);
}

TEST_CASE("a number that is not finite is told, with its particle") {
  const Stepped run({"collisions.friction.tangential_restitution=0.6"});
  simulation::SimulationState state = run.simulation.state();
  CHECK(fault_of_numbers(state).empty());
  state.particles.bodies[40].elements.guiding_y = not_a_number;
  const std::string id = std::to_string(state.particles.ids[40]);
  CHECK(fault_of_numbers(state) == "particle " + id + " has elements that are not finite");
  state = run.simulation.state();
  state.particles.spins[40].y() = not_a_number;
  CHECK(fault_of_numbers(state) == "particle " + id + " has a spin that is not finite");
  CHECK(fault_of_budget(state, run.means_of(state), run.frequencies()) == fault_of_numbers(state));
  state = run.simulation.state();
  state.forces[0].accelerations[40].z() = 1.0 / 0.0;
  CHECK(fault_of_numbers(state) == "particle " + id + " has an acceleration by gravity that is not finite");
}

TEST_CASE("particles that go, or change their size, are told") {
  const Stepped run;
  CHECK(fault_of_particles(run.before.state, run.simulation.state()).empty());
  simulation::SimulationState state = run.simulation.state();
  state.particles.bodies[3].mass *= 1.0 + 1e-15;
  CHECK(fault_of_particles(run.before.state, state) ==
        "particle " + std::to_string(state.particles.ids[3]) + " has another radius or mass than before");
  state = run.simulation.state();
  state.particles.bodies.pop_back();
  state.particles.ids.pop_back();
  CHECK(fault_of_particles(run.before.state, state) == "there are 99 particles, and were 100");
}

TEST_CASE("an overlap beyond rounding is told, with its pair and its depth") {
  const Stepped run;
  Patch patch = run.simulation.patch();
  CHECK(fault_of_overlap(cells::largest_overlap(patch)).empty());
  const double distance = (patch.radii[7] + patch.radii[30]) * (1.0 - 1e-6);
  patch.positions[30] = patch.positions[7] + Vec3(0.0, 0.0, distance);
  patch.positions[7].z() += 500.0;
  patch.positions[30].z() += 500.0;
  CHECK(fault_of_overlap(cells::largest_overlap(patch)) ==
        "particles 7 and 30 overlap by 1e-6 of their radius sum (1e-08 is allowed)");
}

TEST_CASE("a velocity that one particle alone has got is told by the sums and by the energy") {
  for (const std::vector<std::string>& kind : kinds) {
    const Stepped run(kind);
    CAPTURE(run.scene.resolved);
    CHECK(run.sums(run.simulation.state()).empty());
    CHECK(run.energy(run.simulation.state()).empty());
    for (const Vec3& dv : {Vec3(1e-3, 0.0, 0.0), Vec3(0.0, 1e-3, 0.0), Vec3(0.0, 0.0, 1e-3)}) {
      simulation::SimulationState state = run.simulation.state();
      kick(state.particles.bodies[11].elements, dv, run.frequencies(), Rotation());
      CHECK(run.sums(state).find("collisions changed the sum of m ") == 0);
      CHECK(run.energy(state).find("the energy budget of the step does not close") == 0);
    }
  }
}

TEST_CASE("a contact whose energy is booked twice, or never, is told by the energy alone") {
  const Stepped run;
  simulation::SimulationState state = run.simulation.state();
  state.collisions.energy_lost *= 1.0 + 1e-6;
  CHECK(run.sums(state).empty());
  CHECK_FALSE(run.energy(state).empty());
  CHECK(run.energy(run.simulation.state()).empty());
  state.collisions.energy_lost *= 1.001;
  CHECK(fault_of_budget(state, run.means_of(state), run.frequencies()).find("the energy budget does not close") == 0);
}

TEST_CASE("wraps with a wrong shift, and kicks of half the size, are told by the sums") {
  const Stepped run({"constant_acceleration.azimuthal=1e-9"});
  simulation::SimulationState state = run.simulation.state();
  Elements& wrapped = state.particles.bodies[11].elements;
  wrapped = state.box.image_of(wrapped, {1, 0}, state.epoch_offset()); // another image: equivalent
  CHECK(run.sums(state).empty());
  wrapped.guiding_y += 1e-3 * state.box.size_y; // as if the shear offset were that of another time
  CHECK(run.sums(state).find("collisions changed the sum of m Y") == 0);
  BeforeStep before = run.before;
  for (Vec3& acceleration : before.state.forces[1].accelerations)
    acceleration *= 0.5;
  CHECK(fault_of_sums(before, run.simulation.state(), run.frequencies()).find("collisions changed the sum of m ") == 0);
}

TEST_CASE("forces that err by more than the solver may are told, with the particle where they err most") {
  for (const char* solver : {"tree", "fft", "direct"}) {
    CAPTURE(solver);
    const Stepped run({std::string("gravity.solver=") + solver});
    simulation::SimulationState state = run.simulation.state();
    const forces::Boundary boundary = run.simulation.boundary();
    CHECK(fault_of_forces(run.scene, boundary, state).empty());
    for (Vec3& acceleration : state.forces[0].accelerations)
      acceleration *= 1.0 + 1.3 * forces_factor * force_tolerance(*run.scene.gravity);
    const std::string fault = fault_of_forces(run.scene, boundary, state);
    CHECK(fault.find(fmt::format("the forces on {} particles have a relative rms error of ",
                                 std::min<std::size_t>(state.particles.size(), 1024))) == 0);
  }
  const Stepped mean_field({"gravity.solver=mesh"}); // does not approximate the sum over pairs
  CHECK(force_tolerance(*mean_field.scene.gravity) == 0.0);
  CHECK(fault_of_forces(mean_field.scene, mean_field.simulation.boundary(), mean_field.simulation.state()).empty());
}

TEST_CASE(
    "one particle whose force errs by as much as a tree's may, and more than a small sample allows, is no fault") {
  const Stepped run({"gravity.solver=tree", "box.size=[60.0,50.0]", "particles.count=400"});
  const forces::Boundary boundary = run.simulation.boundary();
  simulation::SimulationState state = run.simulation.state();
  std::vector<Vec3>& accelerations = state.forces[0].accelerations;
  double squares = 0.0;
  for (const Vec3& acceleration : accelerations)
    squares += acceleration.squaredNorm();
  const double allowed = forces_factor * force_tolerance(*run.scene.gravity);
  const double rms = std::sqrt(squares / static_cast<double>(accelerations.size()));
  REQUIRE(accelerations.size() > 4 * 32);
  for (Vec3& acceleration : accelerations) { // some of them are in the sample of 32
    const Vec3 without = acceleration;
    acceleration.x() += 1.5 * std::sqrt(32.0) * allowed * rms;
    CHECK(fault_of_forces(run.scene, boundary, state).empty());
    acceleration = without;
  }
}

TEST_CASE("a neighbour that was missed is told") {
  collision::NeighbourAudit audit;
  CHECK(fault_of_neighbours(audit).empty());
  audit.missed = {4, 17, {1, -1}, 1.25, false};
  CHECK(
      fault_of_neighbours(audit) ==
      "particle 4 may touch particle 17 (image 1, -1), 1.25 radius sums from it in the middle of the step, and is not "
      "among its neighbours when the step begins");
}

} // namespace invariants_test
