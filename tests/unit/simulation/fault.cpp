// A state from a file that does not fit the scene is refused: a step could read beyond arrays.
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <utility>

namespace fault_test {

using namespace keeler;
using namespace keeler::simulation;

TEST_CASE("a state whose parts do not fit each other or the scene has a fault") {
  const Scene scene = parse_scene(R"(
planet.orbital_frequency = 1.95e-4
box.size = [40.0, 40.0]
particles = { count = 20, density = 600.0, sizes = { law = "equal", radius = 1.0 } }
moonlet = [{ radius = 2.0, density = 900.0 }]
gravity.solver = "tree"
time = { step = "auto", end = 1.0 }
)",
                                  "test scene");
  Simulation run(scene, initial_patch(scene));
  for (int k = 0; k < 9; ++k) {
    CHECK(run.state().fault(scene).empty());
    run.advance();
  }
  const std::pair<const char*, std::function<void(SimulationState&)>> faults[] = {
      {"lengths", [](SimulationState& s) { s.particles.ids.pop_back(); }},
      {"no particles", [](SimulationState& s) { s.particles = {}; }},
      {"moonlets", [](SimulationState& s) { s.moonlets.clear(); }},
      {"gravity", [](SimulationState& s) { s.forces[0].accelerations.resize(3); }},
      {"gravity", [](SimulationState& s) { s.forces[0].moonlet_gains.clear(); }},
      {"step of 0 ticks", [](SimulationState& s) { s.control.step = 0; }},
      {"begin at tick", [](SimulationState& s) { s.step = -64; }},
      {"rad long", [](SimulationState& s) { s.step_length *= 2.0; }},
      {"rad long", [](SimulationState& s) { s.step_length = std::numeric_limits<double>::quiet_NaN(); }},
      {"box", [](SimulationState& s) { s.box.size_x = 0.0; }},
      {"box", [](SimulationState& s) { s.box.first_offset = -1.0; }},
  };
  for (const auto& [words, make] : faults) {
    SimulationState state = run.state();
    make(state);
    const std::string fault = state.fault(scene);
    CHECK_MESSAGE(fault.find(words) != std::string::npos, fault);
  }
}

} // namespace fault_test
