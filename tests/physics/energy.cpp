// Where the energy of a run goes: every joule of the random motions is booked as a kick's work, as work of the shear by
// one of its stresses, or as lost in a collision.
#include "physics/scenes.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/diagnostics/particle_means.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

Scene patch_with_gravity(int kick_every, const std::vector<std::string>& overrides = {}) {
  return parse_scene(fmt::format(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [60.0, 50.0]
[particles]
optical_depth = 0.5
density = 600.0
sizes = {{ law = "power", exponent = 2.9, min = 0.5, max = 2.0 }}
[gravity]
solver = "tree"
kick_every = {}
[time]
step = 2e-3
end = 1.0
)",
                                 kick_every),
                     "test scene", overrides);
}

} // namespace

TEST_CASE("the energy budget of a self-gravitating patch closes to rounding, and nothing overlaps") {
  for (const int kick_every : {1, 5}) {
    const Scene scene = patch_with_gravity(kick_every);
    Simulation simulation(scene, initial_patch(scene));
    for (int k = 0; k < 500; ++k)
      simulation.advance();
    const simulation::SimulationState& state = simulation.state();
    CHECK(state.collisions.fast > 1000);
    CHECK(state.kick_work() != 0.0);
    const simulation::EnergyBalance b = simulation.balance();
    CHECK(b.translational_flux != 0.0);
    // roundings of thousands of collisions
    CHECK(std::fabs(b.residual) < 1e-12 * b.lost);
    const double shear = scene.planet.frequencies.shear();
    const double gained = shear * (b.translational_flux + b.collisional_flux) + b.kick_work + b.resting_work - b.lost;
    CHECK(b.energy - b.start == doctest::Approx(gained).epsilon(1e-10));
    CHECK(cells::largest_overlap(simulation.patch()).depth < 1e-9);
  }
}

TEST_CASE("with rough spheres the spins' energy is in the budget, and it closes") {
  for (const char* coefficient : {"\"unlimited\"", "0.3"}) {
    const Scene scene = patch_with_gravity(
        2, {fmt::format("collisions.friction={{tangential_restitution=0.4, coefficient={}}}", coefficient)});
    Simulation simulation(scene, initial_patch(scene));
    for (int k = 0; k < 300; ++k)
      simulation.advance();
    const simulation::EnergyBalance b = simulation.balance();
    CHECK(simulation.state().collisions.fast > 1000);
    const diagnostics::ParticleMeans means = simulation.means();
    CHECK(std::fabs(means.spin.energy - simulation.state().energy.spin) > 1e-3 * b.lost);
    CHECK(std::fabs(b.residual) < 1e-12 * b.lost);
    const double shear = scene.planet.frequencies.shear();
    const double gained = shear * (b.translational_flux + b.collisional_flux) + b.kick_work + b.resting_work - b.lost;
    CHECK(b.energy - b.start == doctest::Approx(gained).epsilon(1e-10));
  }
}

TEST_CASE("elastic spheres without gravity gain the work of the shear, no more and no less") {
  const Scene scene = test::spheres(0.5, 400, 5e-3, R"({ law = "constant", value = 1.0 })", 2);
  Simulation simulation(scene, initial_patch(scene));
  for (int k = 0; k < 400; ++k)
    simulation.advance();
  CHECK(simulation.state().collisions.energy_lost == 0.0);
  const simulation::EnergyBalance b = simulation.balance();
  CHECK(std::fabs(b.residual) < 1e-12 * b.energy);
  const double shear = scene.planet.frequencies.shear();
  CHECK(b.energy - b.start == doctest::Approx(shear * (b.translational_flux + b.collisional_flux)).epsilon(1e-10));
}

TEST_CASE("the translational flux is the time integral of sum m c_x c_y, sampled densely") {
  const Scene scene = test::spheres(0.5, 400, 1e-3, R"({ law = "constant", value = 0.5 })", 2);
  Simulation simulation(scene, initial_patch(scene));
  double integral = 0.0; // trapezium over 300 steps of 1/1000 orbit
  const auto stress = [&] {
    const Patch patch = simulation.patch();
    double sum = 0.0;
    for (std::size_t k = 0; k < patch.size(); ++k) {
      const Vec3 c = diagnostics::peculiar_velocity(patch, k);
      sum += patch.masses[k] * c.x() * c.y();
    }
    return sum;
  };
  double before = stress();
  for (int k = 0; k < 300; ++k) {
    simulation.advance();
    const double after = stress();
    integral += 0.5 * (before + after) * scene.step_length();
    before = after;
  }
  // the velocities jump in collisions between samples: first order in the step for a few of them
  CHECK(simulation.balance().translational_flux == doctest::Approx(integral).epsilon(0.01));
}
