// Lists of tables in a scene: [[moonlet]].
#include "scenes.hpp"

#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

namespace moonlets_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

namespace {

const std::string two =
    "[[moonlet]]\nradius = 5.0\ndensity = 450.0\n"                                               // 11
    "[[moonlet]]\nposition = [-20, 10, 0.5]\nradius = 2\nmass = 3e4\nvelocity = [0, 1e-3, 0]\n"; // 14

std::string with_two(const std::string& part, const std::string& by) {
  return fault(least + changed(two, part, by));
}

} // namespace

TEST_CASE("moonlets are read in the order of the scene") {
  const Scene scene = parse_scene(least + two, "s.toml");
  REQUIRE(scene.moonlets.size() == 2);
  CHECK(scene.moonlets[0].radius == 5.0);
  CHECK(scene.moonlets[0].mass == doctest::Approx(450.0 * 4.0 / 3.0 * pi * 125.0).epsilon(1e-15));
  CHECK(scene.moonlets[0].position == Vec3::Zero());
  CHECK(scene.moonlets[0].velocity == Vec3::Zero());
  CHECK(scene.moonlets[1].radius == 2.0);
  CHECK(scene.moonlets[1].mass == 3e4);
  CHECK(scene.moonlets[1].position == Vec3(-20.0, 10.0, 0.5));
  CHECK(scene.moonlets[1].velocity == Vec3(0.0, 1e-3, 0.0));
  CHECK(parse_scene(least, "s.toml").moonlets.empty());
  CHECK(scene.particles.count == 300); // the particles' numbers stay theirs
  CHECK(scene.optical_depth() == parse_scene(least, "s.toml").optical_depth());
}

TEST_CASE("the resolved scene has each moonlet and reads back to an equal scene") {
  const Scene scene = parse_scene(least + two, "s.toml");
  CHECK(scene.resolved.find("\n[[moonlet]]\nradius = 5.0\ndensity = 450.0\nposition = [0.0, 0.0, 0.0]\n") !=
        std::string::npos);
  CHECK(scene.resolved.find("\n[[moonlet]]\nradius = 2.0\nmass = 30000.0\nposition = [-20.0, 10.0, 0.5]\n") !=
        std::string::npos);
  CHECK(parse_scene(scene.resolved, "r.toml").resolved == scene.resolved);
  CHECK(parse_stored_scene(scene.resolved, "r.toml").moonlets.size() == 2);
  CHECK(scene.motion == parse_scene(least, "s.toml").motion); // the state holds them
}

TEST_CASE("overrides replace all moonlets") {
  const std::vector<std::string> one = {"moonlet=[{ radius = 3.0, density = 900.0 }]"};
  const Scene scene = parse_scene(least + two, "s.toml", one);
  REQUIRE(scene.moonlets.size() == 1);
  CHECK(scene.moonlets[0].radius == 3.0);
  CHECK(parse_scene(least, "s.toml", one).moonlets.size() == 1);
}

TEST_CASE("faults of a moonlet are reported with its number and line") {
  CHECK(with_two("radius = 2", "radius = -2") ==
        "s.toml:16:10: moonlet[2].radius is -2, but must be a number from 1e-6 to 1000000 (radius of a body among the "
        "particles, one per table [[moonlet]], in m); write for example radius = 30.0");
  CHECK(with_two("mass = 3e4", "mass = -3e4")
            .find("s.toml:17:8: moonlet[2].mass is -30000.0, but must be a number "
                  "from 1e-20 to 1e24") == 0);
  CHECK(with_two("mass = 3e4", "mass = 3e4\ndensity = 900") ==
        "s.toml:18:1: moonlet[2].density cannot be combined with moonlet[2].mass (each determines the other); keep one "
        "of the "
        "two");
  CHECK(with_two("density = 450.0\n", "") == "s.toml:11:1: moonlet[1].density is missing (density of the body's "
                                             "material, in kg/m^3); add for example density = "
                                             "900.0 or mass");
  CHECK(with_two("mass = 3e4", "mass = 3e9").find("s.toml:17:8: moonlet[2].mass gives a density of 8.95e7 kg/m^3") ==
        0);
  CHECK(with_two("[-20, 10, 0.5]", "[-20, 10]")
            .find("moonlet[2].position is a list of 2 numbers, but must be three "
                  "numbers") != std::string::npos);
  CHECK(with_two("[-20, 10, 0.5]", "[-51, 10, 0]")
            .find("moonlet[2].position is outside the box (it extends 50 m and 25 m") != std::string::npos);
  CHECK(with_two("[-20, 10, 0.5]", "[-20, 10, -101]")
            .find("moonlet[2] reaches 101 m from the mid-plane (more than the longer side of the box, 100 m") !=
        std::string::npos);
  CHECK(with_two("[0, 1e-3, 0]", "[0, 0, 1]").find("moonlet[2] reaches ") != std::string::npos);
  CHECK(with_two("radius = 5.0", "radius = 25.5")
            .find("moonlet[1] is 51 m across (more than one side of the box of 100 m "
                  "x 50 m)") != std::string::npos);
  CHECK(with_two("radius = 2", "radus = 2")
            .find("unknown key moonlet[2].radus (no scene has it); did you mean "
                  "\"radius\"?") != std::string::npos);
  CHECK(fault(least + "[moonlet]\nradius = 1\ndensity = 900\n") ==
        "s.toml:11:1: moonlet is a table, but must be a list of tables (there may be several); write [[moonlet]] and "
        "its keys below");
  CHECK(fault(least + "[[collisions]]\nfinder = \"certified\"\n")
            .find("collisions is a list of tables, but must be a "
                  "table") != std::string::npos);
  const std::string elsewhere = changed(changed(least, "[box]\nsize = [100, 50.0]\n", ""),
                                        "[particles]\ncount = 300\ndensity = 900\nsizes = { law = \"equal\", radius = "
                                        "1.0 }\n",
                                        "[start]\nfrom = \"a.hdf\"\n");
  CHECK(fault(elsewhere).empty());
  CHECK(fault(elsewhere + two).find("[[moonlet]] cannot be combined with start.from") != std::string::npos);
}

TEST_CASE("moonlets that overlap are refused, also across the edge") {
  const std::string near = "s.toml:14:1: moonlet[1] and moonlet[2] overlap (their centres are ";
  CHECK(with_two("[-20, 10, 0.5]", "[6, 0, 0]").find(near + "6 m apart, their radii 5 m and 2 m); move one") == 0);
  CHECK(with_two("[-20, 10, 0.5]", "[7, 0, 0]").empty());
  const std::string at_the_edge =
      changed(changed(two, "[[moonlet]]\n", "[[moonlet]]\nposition = [48, 0, 0]\n"), "[-20, 10, 0.5]", "[-48, 0, 0]");
  CHECK(fault(least + at_the_edge).find("overlap (their centres are 4 m apart") != std::string::npos);
}

} // namespace moonlets_test
