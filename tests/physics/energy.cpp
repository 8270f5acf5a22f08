// Where the energy of a run goes: every joule of the epicyclic energy is booked as a kick's work, as work across the
// sheared edges, or as lost in a collision.
#include "physics/scenes.hpp"

#include <keeler/cells/overlap.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

Scene patch_with_gravity(int kick_every) {
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
                     "test scene");
}

} // namespace

TEST_CASE("the energy budget of a self-gravitating patch closes to rounding, and nothing overlaps") {
  for (const int kick_every : {1, 5}) {
    const Scene scene = patch_with_gravity(kick_every);
    Simulation simulation(scene, initial_patch(scene));
    for (int k = 0; k < 500; ++k)
      simulation.advance();
    const SimulationState& state = simulation.state();
    CHECK(state.collisions.fast > 1000);
    CHECK(state.kick_work() != 0.0);
    CHECK(state.energy.wrap_work != 0.0);
    // roundings of the largest term, Σ m S κ² X²/4, some thousand of them
    CHECK(std::fabs(simulation.energy_residual()) < 1e-11 * std::fabs(state.energy.start));
    CHECK(largest_overlap(simulation.patch()).depth < 1e-9);
  }
}

TEST_CASE("elastic spheres without gravity keep their energy but for the work across the edges") {
  const Scene scene = test::spheres(0.5, 400, 5e-3, R"({ law = "constant", value = 1.0 })", 2);
  Simulation simulation(scene, initial_patch(scene));
  for (int k = 0; k < 400; ++k)
    simulation.advance();
  CHECK(simulation.state().collisions.energy_lost == 0.0);
  CHECK(std::fabs(simulation.energy_residual()) < 1e-11 * std::fabs(simulation.state().energy.start));
}
