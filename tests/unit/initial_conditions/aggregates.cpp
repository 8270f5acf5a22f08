// Aggregates in initial states: filling factor, position, rigid rotation, and no other particles inside.
#include "aggregate.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

namespace aggregates_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

const std::string equal = "sizes = { law = \"equal\", radius = 1.0 }\n",
                  wide = "sizes = { law = \"power\", exponent = 3.0, min = 0.3, max = 3.0 }\n",
                  mixed = "sizes = { law = \"populations\", populations = [[1.5, 300, 900.0], [0.6, 900, 450.0]] }\n";

const std::string two =
    "[[particles.aggregate]]\ncount = 200\nposition = [33, -10, 2]\nfilling_factor = 0.5\n"
    "[[particles.aggregate]]\ncount = 60\nposition = [-15, 20, 0]\nfilling_factor = 0.35\nspin = -1.5\n";

Scene scene_with(const std::string& sizes, const std::string& more, const std::vector<std::string>& overrides = {}) {
  const std::string density = sizes == mixed ? "" : "density = 900.0\n";
  return parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [70, 90]\ntime.end = 1.0\n"
                     "[particles]\noptical_depth = 0.4\n" +
                         density + sizes + more,
                     "s.toml", overrides);
}

struct Pile {
  Vec3 place = Vec3::Zero(), velocity = Vec3::Zero(); // of the centre of mass
  double mass = 0.0, cubes = 0.0, farthest = 0.0;     // largest distance of a surface from the centre of the ball
};

Pile pile_of(const Patch& patch, const scene::AggregateSettings& a) {
  Pile pile;
  for (std::size_t k = a.first; k < a.first + a.count; ++k) {
    pile.mass += patch.masses[k];
    pile.cubes += std::pow(patch.radii[k], 3);
    pile.place += patch.masses[k] * patch.positions[k];
    pile.velocity += patch.masses[k] * patch.velocities[k];
    pile.farthest = std::max(pile.farthest, (patch.positions[k] - a.position).norm() + patch.radii[k]);
  }
  pile.place /= pile.mass;
  pile.velocity /= pile.mass;
  return pile;
}

} // namespace

TEST_CASE("random packings are inside of their ball, and nothing in them overlaps") {
  RandomStream random(5, RandomPurpose::sample, 0);
  std::vector<double> equal_radii(300, 1.0), wide_radii;
  for (int k = 0; k < 300; ++k)
    wide_radii.push_back(0.1 * std::pow(30.0, random.uniform()));
  for (const std::vector<double>& radii : {equal_radii, wide_radii}) {
    double cubes = 0.0;
    for (const double r : radii)
      cubes += r * r * r;
    for (const double filling : {0.05, 0.3, 0.52}) {
      const double ball = std::cbrt(cubes / filling);
      const std::vector<Vec3> places = pack_ball(radii, ball, 1, 0);
      REQUIRE(places.size() == radii.size());
      double gap = 1.0;
      for (std::size_t i = 0; i < radii.size(); ++i) {
        CHECK(places[i].norm() + radii[i] <= ball);
        for (std::size_t j = 0; j < i; ++j)
          gap = std::min(gap, (places[i] - places[j]).norm() - radii[i] - radii[j]);
      }
      CHECK(gap > 0.0);
    }
    CHECK(pack_ball(radii, std::cbrt(cubes / 0.70), 1, 0).empty()); // random packings of equal spheres end at 0.64
  }
  CHECK(pack_ball(std::vector<double>{1.0}, 1.2, 1, 0).size() == 1);
  CHECK(pack_ball(std::vector<double>{1.0, 1.0}, 1.99, 1, 0).empty()); // two side by side need 2
  CHECK(pack_ball(std::vector<double>{1.0, 1.0}, 2.02, 1, 0).size() == 2);
}

TEST_CASE("aggregates have the filling, the place and the spin of the scene, on circular orbits") {
  for (const std::string& sizes : {equal, wide, mixed}) {
    const Scene scene = scene_with(sizes, two);
    const Patch patch = initial_patch(scene);
    const double shear = scene.planet.frequencies.shear();
    REQUIRE(patch.size() == scene.particles.count);
    CHECK(cells::largest_overlap(patch).depth == 0.0);
    CHECK(patch.spins.empty());
    for (const scene::AggregateSettings& a : scene.particles.aggregates) {
      const Pile pile = pile_of(patch, a);
      CHECK(pile.mass == doctest::Approx(a.mass).epsilon(1e-12));
      CHECK(pile.farthest <= a.radius);
      CHECK(pile.cubes / std::pow(a.radius, 3) == doctest::Approx(a.filling).epsilon(1e-12));
      CHECK((pile.place - a.position).norm() < (sizes == equal ? 0.1 : 0.4) * a.radius);
      const Vec3 circular(0.0, -shear * pile.place.x(), 0.0);
      CHECK((pile.velocity - circular).norm() < 1e-12 * shear * 70.0);
      for (std::size_t k = a.first; k < a.first + a.count; ++k) {
        const Vec3 arm = patch.positions[k] - pile.place, turning(-arm.y(), arm.x(), 0.0);
        CHECK((patch.velocities[k] - circular - (a.spin - 1.0) * turning).norm() < 1e-11);
        CHECK(patch.ids[k] == k);
      }
      for (std::size_t k = 0; k < scene.particles.free_count(); ++k) // none inside
        CHECK((patch.positions[k] - a.position).norm() > a.radius + patch.radii[k]);
    }
    Vec3 momentum = Vec3::Zero(); // of all other particles, relative to the shear
    double mass = 0.0;
    for (std::size_t k = 0; k < scene.particles.free_count(); ++k) {
      momentum += patch.masses[k] * (patch.velocities[k] + Vec3(0.0, shear * patch.positions[k].x(), 0.0));
      mass += patch.masses[k];
    }
    CHECK(momentum.norm() < 1e-12 * mass * patch.velocities[0].norm());
  }
}

TEST_CASE("rough particles of an aggregate spin as it does") {
  const Scene scene = scene_with(equal, two, {"collisions.friction.tangential_restitution=0.5"});
  const Patch patch = initial_patch(scene);
  REQUIRE(patch.spins.size() == patch.size());
  CHECK(patch.spins[0] == Vec3::Zero());
  CHECK(patch.spins[scene.particles.aggregates[0].first] == Vec3(0.0, 0.0, 1.0));
  CHECK(patch.spins.back() == Vec3(0.0, 0.0, -1.5));
  CHECK(initial_patch(scene_with(equal, "", {"collisions.friction.tangential_restitution=0.5"})).spins.empty());
}

TEST_CASE("aggregates stand beside moonlets, patterns and streamlines, or alone") {
  const std::string moonlet = "[[moonlet]]\nradius = 6.0\ndensity = 450.0\nposition = [0, -30, 0]\n";
  const Scene beside =
      scene_with(equal, two + moonlet, {"particles.density_step={ between = [-20, 10], factor = 3.0 }"});
  const Patch patch = initial_patch(beside);
  CHECK(patch.size() == beside.particles.count + 1);
  CHECK(patch.radii.back() == 6.0);
  CHECK(patch.positions.back() == Vec3(0.0, -30.0, 0.0));
  CHECK(cells::largest_overlap(patch).depth == 0.0);
  const Scene waves = scene_with(equal, two, {"particles.modes.standing=[[1, 0.3, 0.0]]"});
  CHECK(cells::largest_overlap(initial_patch(waves)).depth == 0.0);
  const Scene alone = scene_with(equal, "[[particles.aggregate]]\ncount = 150\n", {"particles.count=150"});
  const Patch ball = initial_patch(alone);
  CHECK(ball.size() == 150);
  CHECK(cells::largest_overlap(ball).depth == 0.0);
  CHECK(pile_of(ball, alone.particles.aggregates[0]).farthest < alone.particles.aggregates[0].radius);
}

TEST_CASE("a filling that cannot be reached is refused in one line") {
  const Scene scene = scene_with(equal, "[[particles.aggregate]]\ncount = 20\nfilling_factor = 0.6\n");
  CHECK_THROWS_WITH_AS(initial_patch(scene),
                       "particles.aggregate[1]: 20 particles cannot be packed at random to a filling of 0.6 (fewer "
                       "particles reach only a lower filling); lower its filling",
                       UsageError);
}

TEST_CASE("a start with aggregates has the same bits for any number of threads") {
  const Scene scene = scene_with(wide, two);
  const int before = threads();
  set_threads(1);
  const Patch one = initial_patch(scene);
  for (const int count : {2, 3}) {
    set_threads(count);
    const Patch several = initial_patch(scene);
    CHECK(several.positions == one.positions);
    CHECK(several.velocities == one.velocities);
  }
  set_threads(before);
}

} // namespace aggregates_test
