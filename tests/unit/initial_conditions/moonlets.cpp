// Particles are placed around the moonlets of a scene.
#include <keeler/cells/overlap.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

namespace moonlets_test {

using namespace keeler;

namespace {

const std::string moonlets =
    "[[moonlet]]\nradius = 12.0\ndensity = 450.0\nposition = [31, -10, 2]\n"
    "[[moonlet]]\nradius = 0.2\nmass = 20.0\nposition = [-32, 5, 0]\nvelocity = [1e-3, 0, 2e-3]\n";

Scene scene_with(const std::string& more, const std::string& sizes) {
  return parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [70, 90]\ntime.end = 1.0\n"
                     "[particles]\noptical_depth = 0.8\ndensity = 900.0\n" +
                         sizes + more,
                     "s.toml");
}

} // namespace

TEST_CASE("moonlets stand where the scene says, with the last ids, and nothing overlaps them") {
  for (const std::string sizes : {"sizes = { law = \"equal\", radius = 1.0 }\n",
                                  "sizes = { law = \"power\", exponent = 3.0, min = 0.1, max = 4.0 }\n"}) {
    const Scene scene = scene_with(moonlets, sizes);
    const Patch patch = initial_patch(scene);
    const std::size_t count = scene.particles.count;
    REQUIRE(patch.size() == count + 2);
    CHECK(cells::largest_overlap(patch).depth == 0.0);
    CHECK(patch.positions[count] == Vec3(31.0, -10.0, 2.0));
    CHECK(patch.radii[count] == 12.0);
    CHECK(patch.masses[count] == scene.moonlets[0].mass);
    CHECK(patch.ids[count] == count);
    const double shear = scene.planet.frequencies.shear(), omega = scene.planet.orbital_frequency;
    CHECK(patch.velocities[count] == Vec3(0.0, -shear * 31.0, 0.0)); // a circular orbit
    CHECK(patch.positions[count + 1] == Vec3(-32.0, 5.0, 0.0));
    CHECK(patch.masses[count + 1] == 20.0);
    CHECK(patch.ids[count + 1] == count + 1);
    CHECK((patch.velocities[count + 1] - Vec3(1e-3 / omega, shear * 32.0, 2e-3 / omega)).norm() < 1e-12 / omega);
    Vec3 momentum = Vec3::Zero();
    double mass = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      momentum += patch.masses[k] * (patch.velocities[k] + Vec3(0.0, shear * patch.positions[k].x(), 0.0));
      mass += patch.masses[k];
    }
    CHECK(momentum.norm() < 1e-12 * mass * patch.velocities[0].norm());
  }
}

TEST_CASE("moonlets that touch keep their places, and grains keep clear of them") {
  const Scene scene = scene_with("[[moonlet]]\nradius = 6.0\ndensity = 450.0\nposition = [-6, 0, 0]\n"
                                 "[[moonlet]]\nradius = 6.0\ndensity = 450.0\nposition = [6, 0, 0]\n",
                                 "sizes = { law = \"equal\", radius = 0.5 }\n");
  CHECK(cells::largest_overlap(initial_patch(scene)).depth == 0.0);
}

TEST_CASE("a start with moonlets has the same bits for any number of threads") {
  const Scene scene = scene_with(moonlets, "sizes = { law = \"power\", exponent = 3.0, min = 0.2, max = 3.0 }\n");
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

} // namespace moonlets_test
