// [[particles.aggregate]]: which particles, how large, and what is refused.
#include "scenes.hpp"

#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

namespace aggregates_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

namespace {

const std::string two = "[[particles.aggregate]]\ncount = 64\nposition = [-20, 5, 1]\n"                       // 11
                        "[[particles.aggregate]]\ncount = 100\nfilling_factor = 0.4\nposition = [30, 0, 0]\n" // 14
                        "spin = 0.25\n";                                                                      // 18

std::string with_two(const std::string& part, const std::string& by) {
  return fault(least + changed(two, part, by));
}

} // namespace

TEST_CASE("aggregates take the last particles of the scene and change no total") {
  const Scene scene = parse_scene(least + two, "s.toml"), without = parse_scene(least, "s.toml");
  const std::vector<AggregateSettings>& a = scene.particles.aggregates;
  REQUIRE(a.size() == 2);
  CHECK(a[0].first == 300 - 164);
  CHECK(a[0].count == 64);
  CHECK(a[0].filling == 0.5);
  CHECK(a[0].spin == 1.0);
  CHECK(a[0].position == Vec3(-20.0, 5.0, 1.0));
  CHECK(a[0].radius == doctest::Approx(std::cbrt(64.0 / 0.5)).epsilon(1e-14));
  CHECK(a[0].mass == doctest::Approx(64.0 * 900.0 * 4.0 / 3.0 * pi).epsilon(1e-14));
  CHECK(a[1].first == 200);
  CHECK(a[1].filling == 0.4);
  CHECK(a[1].spin == 0.25);
  CHECK(scene.particles.free_count() == 136);
  CHECK(without.particles.free_count() == 300);
  CHECK(scene.optical_depth() == without.optical_depth());
  CHECK(scene.surface_density() == without.surface_density());
  CHECK(scene.bunched_optical_depth() == doctest::Approx(without.optical_depth() * 136.0 / 300.0).epsilon(1e-14));
  CHECK(scene.motion == without.motion); // the state holds them
  CHECK(parse_scene(scene.resolved, "r.toml").resolved == scene.resolved);
  CHECK(scene.resolved.find(
            "\n[[particles.aggregate]]\ncount = 64\nfilling_factor = 0.5\nposition = [-20.0, 5.0, 1.0]\nspin = "
            "1.0\n") != std::string::npos);
  CHECK_NOTHROW(parse_stored_scene(scene.resolved, "r.toml"));
}

TEST_CASE("particles in aggregates do not count for the filling of the layer") {
  const std::string dense = changed(least, "count = 300", "count = 3000"); // an optical depth of 1.9
  const auto crowd = [&](int count) {
    return changed(changed(dense, "count = 3000", "optical_depth = 5.0"), "radius = 1.0", "radius = 0.5") +
           "[[particles.aggregate]]\nfilling_factor = 0.5\ncount = " + std::to_string(count) + "\n";
  };
  CHECK(fault(crowd(10)).find("too dense") != std::string::npos);
  CHECK(fault(crowd(20000)).empty());
}

TEST_CASE("faults of an aggregate are reported with its number and line") {
  CHECK(with_two("count = 64", "count = 201") ==
        "s.toml:15:9: particles.aggregate[2].count = 100 is too large (the scene has 300 particles, of which "
        "201 are in earlier aggregates); lower it or give the scene more particles");
  CHECK(with_two("count = 64", "count = 301").find("s.toml:12:9: particles.aggregate[1].count = 301 is too large") ==
        0);
  CHECK(with_two("count = 64\n", "").find("s.toml:11:1: particles.aggregate[1].count is missing") == 0);
  CHECK(with_two("filling_factor = 0.4", "filling_factor = 0.7")
            .find("particles.aggregate[2].filling_factor is 0.7, but must be a number above 0 and at most 0.64") !=
        std::string::npos);
  CHECK(
      with_two("filling_factor = 0.4", "filling_factor = 0.006") ==
      "s.toml:15:9: particles.aggregate[2] is 51.09 m across (more than one side of the box of 100 m x 50 m); enlarge "
      "the box or lower the count");
  CHECK(with_two("[30, 0, 0]", "[30, 30, 0]")
            .find("s.toml:17:12: particles.aggregate[2].position is outside the box (it extends 50 m and 25 m") == 0);
  CHECK(with_two("[30, 0, 0]", "[30, 0, 1e6]").find("particles.aggregate[2] reaches 1000000 m from the mid-plane") !=
        std::string::npos);
  CHECK(with_two("[30, 0, 0]", "[-15, 0, 0]") ==
        "s.toml:14:1: particles.aggregate[1] and particles.aggregate[2] overlap (their centres are 7.141 m apart, "
        "their radii 5.04 m and 6.3 m); move one");
  CHECK(fault(least + two +
              "[[moonlet]]\nradius = 3\ndensity = 900\nposition = [-45, 0, 0]\n"
              "[[moonlet]]\nradius = 3\ndensity = 900\nposition = [-25, 0, 0]\n")
            .find("s.toml:23:1: particles.aggregate[1] and moonlet[2] overlap") == 0);
  CHECK(fault(least + "[particles.aggregate]\ncount = 9\n").find("must be a list of tables") != std::string::npos);
}

} // namespace aggregates_test
