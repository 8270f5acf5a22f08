// A shared library that is made with the installed package.
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

double gap_after_one_orbit() {
  const keeler::Scene scene = keeler::parse_scene(R"(
    planet.orbital_frequency = 1.95e-4
    box.size = [50.0, 50.0]
    particles = { count = 1, density = 600.0, sizes = { law = "equal", radius = 1.0 } }
    time = { step = 1e-2, end = 1.0 }
  )",
                                                  "consumer");
  const keeler::Frequencies kepler;
  keeler::Elements orbit;
  orbit.e_cos = 0.3;
  orbit.i_sin = 0.2;
  const keeler::State there = keeler::hill::state_at(orbit, kepler, keeler::Rotation(kepler, 0.0));
  keeler::Patch start;
  start.positions = {there.position};
  start.velocities = {there.velocity};
  start.radii = {1.0};
  start.masses = {2500.0};
  start.ids = {0};
  start.box = {50.0, 50.0, kepler.shear(), 0.0};
  start.orbital_frequency = 1.95e-4;
  keeler::Simulation simulation(scene, start);
  while (simulation.state().step < 100)
    simulation.advance();
  return (simulation.patch().positions[0] - there.position).norm();
}
