// A simulation can be moved, like a value in a container.
#include <keeler/collision/costs.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>

#include <cstring>
#include <optional>

namespace moved_test {

using namespace keeler;

TEST_CASE("a simulation that is moved goes on as if it had not been") {
  const Scene scene = parse_scene(R"(
planet.orbital_frequency = 1.95e-4
box.size = [40.0, 40.0]
particles = { optical_depth = 0.5, density = 600.0, sizes = { law = "equal", radius = 1.0 } }
gravity.solver = "tree"
time = { step = 2e-3, end = 1.0 }
)",
                                  "test scene");
  Simulation stays(scene, initial_patch(scene));
  auto first = std::make_unique<Simulation>(scene, initial_patch(scene));
  for (int k = 0; k < 7; ++k) {
    stays.advance();
    first->advance();
  }
  std::optional<Simulation> moved(std::move(*first));
  first.reset();
  CHECK(moved->drift().costs().bytes_per_particle == stays.drift().costs().bytes_per_particle);
  for (int k = 0; k < 20; ++k) {
    stays.advance();
    moved->advance();
  }
  CHECK(stays.state().collisions.fast > 0);
  CHECK(moved->state().collisions.fast == stays.state().collisions.fast);
  const std::vector<Body>&a = stays.state().particles.bodies, &b = moved->state().particles.bodies;
  REQUIRE(a.size() == b.size());
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(Body)) == 0);
}

} // namespace moved_test
