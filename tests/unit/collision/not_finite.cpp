// Numbers that are not finite end a run in the step that meets them first, whatever is kept from earlier steps.
#include "unit/collision/spheres.hpp"
#include "unit/collision/twin.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace not_finite_test {

using namespace keeler;
using test::Ring;
using test::Sphere;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// A row along the orbit, at rest: nothing happens, and neighbours are kept for as long as they may be.
Ring quiet_ring(int count) {
  std::vector<Sphere> spheres;
  for (int k = 0; k < count; ++k)
    spheres.push_back({{0.0, 5.0 * k - 50.0, 0.0}});
  Ring ring(test::patch_of(spheres, 200.0, 200.0), {}, 1e-3);
  ring.keeps_neighbours = true;
  return ring;
}

constexpr std::array<double Elements::*, 6> fields = {&Elements::guiding_x, &Elements::guiding_y, &Elements::e_cos,
                                                      &Elements::e_sin,     &Elements::i_sin,     &Elements::i_cos};

} // namespace

TEST_CASE("elements that are not finite: an error in the next drift") {
  const int before = threads();
  for (const int several : {1, 2}) {
    set_threads(several);
    for (const int count : {1, 2, 20})
      for (const int at : {0, 1, 2, 4, 9, 16, 17, 18, 30})
        for (const auto field : fields)
          for (const double bad : {not_a_number, infinity, -infinity}) {
            CAPTURE(count);
            CAPTURE(at);
            CAPTURE(bad);
            Ring ring = quiet_ring(count);
            for (int k = 0; k < at; ++k)
              ring.advance();
            ring.particles.bodies.back().elements.*field = bad;
            ring.undisturbed = false;
            REQUIRE_THROWS_AS(ring.advance(), InvariantError);
          }
  }
  set_threads(before);
}

TEST_CASE("a kick that is not finite: an error in the next drift, in the midst of a kept window too") {
  for (const double bad : {not_a_number, infinity, -infinity})
    for (const int at : {0, 1, 4, 9, 17}) {
      CAPTURE(bad);
      CAPTURE(at);
      Ring ring = quiet_ring(20);
      for (int k = 0; k < at; ++k)
        ring.advance();
      const Rotation boundary(ring.frequencies, -0.5 * ring.step);
      kick(ring.particles.bodies[7].elements, {0.0, bad, 0.0}, ring.frequencies, boundary);
      ring.undisturbed = false;
      REQUIRE_THROWS_AS(ring.advance(), InvariantError);
    }
}

TEST_CASE("a simulation does not go on from accelerations that are not finite") {
  for (const char* solver : {"direct", "tree"})
    for (const double bad : {not_a_number, infinity, -infinity}) {
      CAPTURE(solver);
      CAPTURE(bad);
      const Scene scene = parse_scene(std::string(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [200.0, 200.0]
[particles]
count = 20
density = 900.0
sizes = { law = "equal", radius = 1.0 }
[gravity]
solver = ")") + solver + "\"\nkick_every = 1\n[time]\nstep = 1e-3\nend = 1.0\n",
                                      "test scene");
      std::vector<Sphere> spheres;
      for (int k = 0; k < 20; ++k)
        spheres.push_back({{0.0, 5.0 * k - 50.0, 0.0}, Vec3::Zero(), 1.0, 3770.0});
      Simulation simulation(scene, test::patch_of(spheres, 200.0, 200.0));
      for (int k = 0; k < 5; ++k)
        simulation.advance();
      simulation::SimulationState state = simulation.state();
      state.forces[0].accelerations[3].y() = bad;
      Simulation again(scene, state);
      REQUIRE_THROWS_AS(again.advance(), InvariantError);
    }
}

} // namespace not_finite_test
