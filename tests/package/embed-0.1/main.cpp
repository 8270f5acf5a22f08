// examples/embed as version 0.1 has it: never changed, since the headers of later versions must compile it.
// A patch of ring in a program of one's own, with a restitution law that no scene has.
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <cmath>
#include <cstdio>

int main() {
  keeler::Scene scene = keeler::parse_scene(R"(
    planet.preset = "saturn-b-ring"
    box.size = [60.0, 60.0]
    particles = { optical_depth = 0.5, density = 600.0, sizes = { law = "equal", radius = 1.0 } }
    collisions.restitution = { law = "constant", value = 0.5 }
    time = { step = 2e-3, end = 1.0 }
  )",
                                            "embed");
  // viscoelastic spheres to first order (Ramirez et al. 1999): 1 - c v^(1/5), here c = 0.9 (m/s)^(-1/5)
  scene.collisions.restitution = [](const keeler::Impact& impact) { return 1.0 - 0.9 * std::pow(impact.speed, 0.2); };

  keeler::Simulation simulation(scene, keeler::initial_patch(scene));
  while (simulation.orbits() < 1.0)
    simulation.advance();

  const keeler::Patch patch = simulation.patch(); // arrays with an entry a particle
  double squares = 0.0;
  for (const keeler::Vec3& position : patch.positions)
    squares += position.z() * position.z();
  std::printf("%zu particles, %.1f collisions of each, scale height %.2f m\n", patch.size(),
              2.0 * static_cast<double>(simulation.state().collisions.fast) / static_cast<double>(patch.size()),
              std::sqrt(squares / static_cast<double>(patch.size())));
}
