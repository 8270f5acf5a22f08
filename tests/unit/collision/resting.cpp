// Dense states under self-gravity: clumps and resting contacts settle, without a storm of contacts, and no sphere sinks
// into another.
#include "draws.hpp"
#include "unit/collision/spheres.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

namespace resting_test {

using namespace keeler;
using test::Sphere;

namespace {

Scene scene_with_gravity(double restitution, int kick_every, double step) {
  return parse_scene(fmt::format(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [80.0, 80.0]
[particles]
count = 200
density = 3000.0
sizes = {{ law = "equal", radius = 1.0 }}
[collisions]
restitution = {{ law = "constant", value = {} }}
[gravity]
solver = "direct"
resting_contacts = "bounced"
kick_every = {}
[time]
step = {}
end = 10.0
)",
                                 restitution, kick_every, step),
                     "test scene");
}

constexpr double mass = 3000.0 * 4.0 / 3.0 * pi; // of a sphere of radius 1: denser than the tide can pull apart

// Returns a ball of a face-centred lattice at filling 0.6, at rest in the rotating frame.
std::vector<Sphere> ball(double radius) {
  const double side = std::cbrt(4.0 * (4.0 / 3.0 * pi) / 0.6);
  std::vector<Sphere> spheres;
  for (int k = 0; k < 8 * 8 * 8 * 4; ++k) {
    const Vec3 corner(test::quotient(k, 4) % 8 - 4, test::quotient(k, 32) % 8 - 4, test::quotient(k, 256) - 4);
    const Vec3 faces[] = {{0.0, 0.0, 0.1}, {0.5, 0.5, 0.1}, {0.5, 0.0, 0.6}, {0.0, 0.5, 0.6}};
    const Vec3 place = side * (corner + faces[k % 4]);
    if (place.norm() < radius)
      spheres.push_back({place, {0.0, 1.5 * place.x(), 0.0}, 1.0, mass});
  }
  return spheres;
}

struct Settled {
  double first = 0.0, second = 0.0; // largest overlap in the first and in the second half
  double most = 0.0;                // contacts of a particle in a step, mean of the worst step
  std::uint64_t contacts = 0;
  double radius = 0.0; // distance of the farthest particle at the end
};

Settled settle(const Scene& scene, const std::vector<Sphere>& spheres, int steps) {
  Simulation simulation(scene, test::patch_of(spheres, 80.0, 80.0, scene.planet.frequencies));
  Settled s;
  for (int k = 0; k < steps; ++k) {
    simulation.advance();
    const CollisionTally& tally = simulation.state().collisions;
    const auto now = tally.fast + tally.slow;
    s.most = std::max(s.most, 2.0 * static_cast<double>(now - s.contacts) / static_cast<double>(spheres.size()));
    s.contacts = now;
    double& overlap = k < steps / 2 ? s.first : s.second;
    overlap = std::max(overlap, cells::largest_overlap(simulation.patch()).depth);
  }
  CHECK(simulation.state().collisions.gave_up == 0);
  for (const Vec3& place : simulation.patch().positions)
    s.radius = std::max(s.radius, place.norm());
  return s;
}

} // namespace

TEST_CASE("a ball at filling 0.6 settles under its own gravity: no storm, and nothing sinks in") {
  const std::vector<Sphere> spheres = ball(6.5);
  CHECK(spheres.size() > 120);
  struct Case {
    double restitution, step; // orbits
    int kick_every;
    std::uint64_t steps;
  };
  for (const Case& c :
       {Case{0.5, 1e-3, 1, 300}, Case{0.5, 4e-3, 1, 120}, Case{0.5, 1e-3, 4, 300}, Case{0.0, 1e-3, 1, 30}}) {
    CAPTURE(c.restitution);
    CAPTURE(c.step);
    CAPTURE(c.kick_every);
    const int steps = static_cast<int>(std::max<std::uint64_t>(30, test::draws(c.steps)));
    const Settled s = settle(scene_with_gravity(c.restitution, c.kick_every, c.step), spheres, steps);
    CHECK(s.contacts > test::draws(1000));
    CHECK(s.most < (c.restitution > 0.0 ? 60.0 : 1000.0)); // three times the observed values, 19 and 315
    // the rounding of |d|² − R² where coordinates are about ten radii
    CHECK(s.first < 1e-13);
    CHECK(s.second < 1e-13);
    CHECK(s.radius < 8.0);
  }
}

TEST_CASE("a pair at rest on each other stays so") {
  for (const double restitution : {0.0, 0.5, 1.0}) {
    const std::vector<Sphere> pair{{{-1.0, 0, 0}, {0, -1.5, 0}, 1.0, mass}, {{1.0, 0, 0}, {0, 1.5, 0}, 1.0, mass}};
    const Settled s = settle(scene_with_gravity(restitution, 1, 2e-3), pair, 500);
    CHECK(s.contacts > 30);
    CHECK(s.most < 10.0);
    CHECK(s.first < 1e-14);
    CHECK(s.second < 1e-14);
    CHECK(s.radius < 1.1); // elastic ones hop, a random walk from kick to kick: 1.02 to 1.05 with other rounding
  }
}

} // namespace resting_test
