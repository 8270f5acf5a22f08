#include "scenes.hpp"

#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace scene_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

TEST_CASE("the least scene has the documented defaults") {
  const Scene scene = parse_scene(least, "s.toml");
  CHECK(scene.title == "");
  CHECK(scene.planet.preset == "");
  CHECK(scene.planet.orbital_frequency == 2e-4);
  CHECK(scene.planet.frequencies.kappa == 1.0);
  CHECK(scene.planet.frequencies.nu == 1.0);
  CHECK(scene.size_x == 100.0);
  CHECK(scene.size_y == 50.0);
  CHECK(scene.particles.count == 300);
  CHECK(scene.particles.density == 900.0);
  CHECK(scene.particles.sizes.smallest == 1.0);
  CHECK(scene.particles.sizes.largest == 1.0);
  CHECK(scene.particles.velocity_dispersion == 2.0);
  CHECK(scene.particles.seed == 1);
  CHECK(scene.particles.streamlines.bunching == 0.0);
  CHECK(scene.particles.streamlines.inclination == 0.0);
  CHECK(scene.collisions.finder == "certified");
  CHECK(scene.collisions.elastic_below == 1e-2);
  CHECK(scene.collisions.restitution({.speed = 0.01}) == 0.34);
  CHECK(!scene.gravity);
  CHECK(!scene.start_from);
  CHECK(scene.time.step == 5e-3);
  CHECK(scene.time.end_step == 400);
  CHECK(scene.output.series_every == 4);
  CHECK(scene.output.snapshot_every == 0);
  CHECK(scene.output.checkpoint_every == 0);
  CHECK(scene.output.checkpoint_every_minutes == 10.0);
  CHECK(scene.notices.empty());
  CHECK(scene.step_length() == doctest::Approx(two_pi * 5e-3).epsilon(1e-15));
  CHECK(scene.optical_depth() == doctest::Approx(300 * pi / 5000).epsilon(1e-14));
  CHECK(scene.surface_density() == doctest::Approx(300 * 900 * (4.0 / 3) * pi / 5000).epsilon(1e-14));
}

TEST_CASE("every key reaches its member of the scene") {
  const Scene scene = parse_scene(R"(
title = "all \"keys\""
[planet]
orbital_frequency = 1e-4
epicyclic_ratio = 0.9
vertical_ratio = 3.6
[box]
size_in_wavelengths = [4, 2]
[particles]
surface_density = 100
density = 500
velocity_dispersion = 12.5
seed = 42
sizes = { law = "power", exponent = 2.5, min = 0.5, max = 5 }
streamlines = { waves = 3, bunching = 0.7, inclination = 1.5 }
[collisions]
finder = "linear-full"
elastic_below_speed = 0
restitution = { law = "constant", value = 0.25 }
[gravity]
solver = "direct"
image_rings = 2
kick_every = 5
[time]
step = 0.01
end = 1.5
[output]
snapshot_every = 0.5
checkpoint_every = 0.25
)",
                                  "s.toml");
  CHECK(scene.title == "all \"keys\"");
  CHECK(scene.planet.orbital_frequency == 1e-4);
  CHECK(scene.planet.frequencies.kappa == 0.9);
  CHECK(scene.planet.frequencies.nu == 3.6);
  const double wavelength = 4 * pi * pi * newton_g_si * 100 / (0.9e-4 * 0.9e-4);
  CHECK(scene.size_x == doctest::Approx(4 * wavelength).epsilon(1e-14));
  CHECK(scene.size_y == doctest::Approx(2 * wavelength).epsilon(1e-14));
  const particles::SizeLaw power = particles::power_sizes(2.5, 0.5, 5.0);
  CHECK(scene.particles.sizes.smallest == 0.5);
  CHECK(scene.particles.sizes.largest == 5.0);
  CHECK(scene.particles.sizes.mean_power(3) == power.mean_power(3));
  CHECK(scene.particles.sizes.radius(0.3, 0) == power.radius(0.3, 0));
  // N is an integer: the surface density is within half a particle of the requested one
  CHECK(std::fabs(scene.surface_density() / 100 - 1) <= 0.5 / static_cast<double>(scene.particles.count));
  CHECK(scene.particles.velocity_dispersion == 12.5);
  CHECK(scene.particles.seed == 42);
  CHECK(scene.particles.streamlines.waves == 3);
  CHECK(scene.particles.streamlines.bunching == 0.7);
  CHECK(scene.particles.streamlines.inclination == 1.5);
  CHECK(scene.bunched_optical_depth() == doctest::Approx(scene.optical_depth() / 0.3).epsilon(1e-14));
  CHECK(scene.collisions.finder == "linear-full");
  CHECK(scene.collisions.elastic_below == 0.0);
  CHECK(scene.collisions.restitution({.speed = 1e-9}) == 0.25);
  REQUIRE(scene.gravity);
  CHECK(scene.gravity->solver == GravitySettings::Solver::direct);
  CHECK(scene.gravity->images.rings == 2);
  CHECK(scene.gravity->kick_every == 5);
  CHECK(scene.time.step == 0.01);
  CHECK(scene.time.end_step == 150);
  CHECK(scene.output.snapshot_every == 50);
  CHECK(scene.output.checkpoint_every == 25);
}

TEST_CASE("modes reach the scene") {
  const Scene scene = parse_scene(
      least + "[particles.modes]\noutward = [[2, 0.1, 30.0]]\nstanding = [[1, 0.25, -90], [3, 0.05, 0]]\n", "s.toml");
  const std::vector<ModeSettings>& modes = scene.particles.modes;
  REQUIRE(modes.size() == 3);
  CHECK(modes[0].direction == ModeSettings::Direction::outward);
  CHECK(modes[0].waves == 2);
  CHECK(modes[0].amplitude == 0.1);
  CHECK(modes[0].phase_degrees == 30.0);
  CHECK(modes[1].direction == ModeSettings::Direction::standing);
  CHECK(modes[1].phase_degrees == -90.0);
  CHECK(modes[2].waves == 3);
  CHECK(scene.bunched_optical_depth() == doctest::Approx(scene.optical_depth() / 0.6).epsilon(1e-14));
  CHECK(scene.resolved.find("[particles.modes]\noutward = [[2.0, 0.1, 30.0]]\ninward = []\nstanding = ") !=
        std::string::npos);
  CHECK(parse_scene(scene.resolved, "r.toml").resolved == scene.resolved);
  const Scene given = parse_scene(least, "s.toml", {"particles.modes.inward=[[4, 0.2, 0]]"});
  REQUIRE(given.particles.modes.size() == 1);
  CHECK(given.particles.modes[0].direction == ModeSettings::Direction::inward);
  CHECK(parse_scene(least, "s.toml").particles.modes.empty());
}

TEST_CASE("an empty gravity section means gravity with its defaults") {
  const Scene scene = parse_scene(least + "[gravity]\n", "s.toml");
  REQUIRE(scene.gravity);
  CHECK(scene.gravity->solver == GravitySettings::Solver::automatic);
  CHECK(scene.gravity->force_error == 4e-3);
  CHECK(scene.gravity->images.rings == 1);
}

TEST_CASE("radial self-gravity needs its shortest wavelength") {
  const Scene scene = parse_scene(least + "[gravity]\nsolver = \"axisymmetric\"\nshortest_wavelength = 20\n", "s.toml");
  CHECK(scene.gravity->solver == GravitySettings::Solver::axisymmetric);
  CHECK(scene.gravity->shortest_wavelength == 20.0);
  CHECK_FALSE(scene.gravity->by_pairs());
  CHECK(scene.motion.find("gravity.shortest_wavelength = 20.0") != std::string::npos);
  CHECK_THROWS_WITH_AS(parse_scene(least + "[gravity]\nsolver = \"axisymmetric\"\n", "s.toml"),
                       doctest::Contains("gravity.shortest_wavelength is missing"), UsageError);
  CHECK_THROWS_WITH_AS(
      parse_scene(least + "[gravity]\nsolver = \"axisymmetric\"\nshortest_wavelength = 101\n", "s.toml"),
      doctest::Contains("gravity.shortest_wavelength = 101 m is longer than the box is wide (100 m"), UsageError);
}

TEST_CASE("populations bring their densities") {
  const std::string text = changed(changed(least, "density = 900\n", ""), "{ law = \"equal\", radius = 1.0 }",
                                   "{ law = \"populations\", populations = [[2, 100, 450], [1, 200, 900]] }");
  const Scene scene = parse_scene(text, "s.toml");
  CHECK(scene.particles.density == doctest::Approx((800.0 * 450 + 200.0 * 900) / 1000.0).epsilon(1e-14));
  CHECK(scene.surface_density() ==
        doctest::Approx(4.0 / 3.0 * pi * (800.0 * 450 + 200.0 * 900) / 5000.0).epsilon(1e-14));
  CHECK(parse_scene(scene.resolved, "r.toml").resolved == scene.resolved);
  CHECK_THROWS_WITH_AS(parse_scene(changed(text, "count = 300\n", "count = 300\ndensity = 900\n"), "s.toml"),
                       doctest::Contains("cannot be combined with"), UsageError);
  CHECK_THROWS_WITH_AS(parse_scene(changed(text, "900]]", "-900]]"), "s.toml"), doctest::Contains("populations"),
                       UsageError);
  CHECK_THROWS_WITH_AS(parse_scene(changed(text, "900]]", "9e4]]"), "s.toml"),
                       doctest::Contains("the density 2 is 90000 kg/m^3"), UsageError);
  CHECK_THROWS_WITH_AS(
      parse_scene(changed(least, "{ law = \"equal\", radius = 1.0 }", "{ law = \"populations\" }"), "s.toml"),
      doctest::Contains("populations are missing"), UsageError);
}

TEST_CASE("the count follows from the optical depth, to the nearest particle") {
  const Scene scene = parse_scene(changed(least, "count = 300", "optical_depth = 0.5"), "s.toml");
  CHECK(scene.particles.count == 796); // 0.5 × 5000 / π = 795.8
  CHECK(scene.size_x == 100.0);
}

TEST_CASE("a preset brings its three frequencies") {
  const Scene scene = parse_scene(changed(least, "orbital_frequency = 2e-4", "preset = \"saturn-a-ring\""), "s.toml");
  CHECK(scene.planet.preset == "saturn-a-ring");
  CHECK(scene.planet.orbital_frequency == 1.3175e-4);
  CHECK(scene.planet.frequencies.kappa == 0.99458);
  CHECK(scene.planet.frequencies.nu == 1.00539);
}

TEST_CASE("a start file replaces box and particles") {
  const std::string text = "planet.preset = \"saturn-b-ring\"\ntime.end = 1\nstart.from = \"../wakes.hdf\"\n";
  const Scene scene = parse_scene(text, "/some/where/s.toml");
  REQUIRE(scene.start_from);
  CHECK(*scene.start_from == "/some/wakes.hdf");
  CHECK(scene.particles.count == 0);
  CHECK(scene.size_x == 0.0);
  CHECK(scene.optical_depth() == 0.0);
  CHECK(scene.surface_density() == 0.0);
  CHECK(parse_scene(scene.resolved, "elsewhere/r.toml").start_from == scene.start_from);
}

TEST_CASE("a stored scene needs no file that only the start needed") {
  const std::string radii =
      changed(least, "{ law = \"equal\", radius = 1.0 }", "{ law = \"file\", path = \"/absent/radii.txt\" }");
  CHECK_THROWS_AS(parse_scene(radii, "s.toml"), UsageError);
  CHECK(parse_stored_scene(radii, "s.h5").time.end_step ==
        parse_scene(least, "s.toml", {"quality=custom"}).time.end_step);

  const Scene fresh = parse_scene(least + "[gravity]\n", "s.toml", {"particles.seed=7"});
  const Scene stored = parse_stored_scene(fresh.resolved, "s.h5");
  CHECK(stored.particles.seed == 7);
  CHECK(stored.planet.frequencies.kappa == fresh.planet.frequencies.kappa);
  CHECK(stored.gravity.has_value());
  CHECK(stored.resolved == fresh.resolved);
  CHECK_THROWS_AS(parse_stored_scene("[planet]\n", "s.h5"), UsageError);
}

TEST_CASE("radii come from a table in the scene") {
  const auto with = [](const std::string& table) {
    return parse_scene(
        changed(least, "{ law = \"equal\", radius = 1.0 }", "{ law = \"table\", table = " + table + " }"), "s.toml");
  };
  const Scene scene = with("[[10.0, 1], [1.0, 99]]");
  CHECK(scene.particles.sizes.radius(0.005, 0) == 10.0);
  CHECK(scene.particles.sizes.radius(0.015, 0) == 1.0);
  CHECK(parse_scene(scene.resolved, "s.toml").particles.sizes.mean_power(2) == doctest::Approx(1.99));
  CHECK_THROWS_WITH_AS(with("[[30.0, 1], [1e7, 99]]"), doctest::Contains("the radius 2 is 10000000 m (it must be from"),
                       UsageError);
  CHECK_THROWS_AS(with("[[30.0, 0]]"), UsageError);
  CHECK_THROWS_AS(with("[[30.0]]"), UsageError);
  CHECK_THROWS_WITH_AS(with("[]"), doctest::Contains("particles.sizes"), UsageError);
}

TEST_CASE("radii are read from a file next to the scene") {
  const auto folder = std::filesystem::temp_directory_path() / "keeler_test_scene_radii";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "radii.txt") << "# metres\n1.0\n  2.5 # the largest\r\n\n0.5\n";
  std::ofstream(folder / "bad.txt") << "1.0\n-2\n";
  std::ofstream(folder / "empty.txt") << "# nothing\n";
  const auto with = [&](const std::string& file) {
    const std::string sizes = "{ law = \"file\", path = \"" + file + "\" }";
    std::ofstream(folder / "s.toml") << changed(least, "{ law = \"equal\", radius = 1.0 }", sizes);
    return load_scene((folder / "s.toml").string());
  };
  const Scene scene = with("radii.txt");
  const particles::SizeLaw& sizes = scene.particles.sizes;
  CHECK(std::vector{sizes.radius(0.0, 0), sizes.radius(0.0, 1), sizes.radius(0.0, 2)} == std::vector{1.0, 2.5, 0.5});
  CHECK(scene.resolved.find("path = \"" + (folder / "radii.txt").string() + "\"") != std::string::npos);

  const std::string here = folder.string();
  CHECK_THROWS_WITH_AS(
      with("bad.txt"),
      (here +
       "/bad.txt:2:1: the line is -2, but must be a number from 1e-6 to 1000000 (radius in m); correct this line")
          .c_str(),
      UsageError);
  CHECK_THROWS_WITH_AS(with("empty.txt"),
                       (here + "/s.toml:8:32: " + here +
                        "/empty.txt has no numbers (it is empty, or has only comments); write radius in m on each line")
                           .c_str(),
                       UsageError);
  CHECK_THROWS_WITH_AS(with("absent.txt"),
                       (here + "/s.toml:8:32: " + here +
                        "/absent.txt cannot be read (No such file or directory); check the path and its permissions")
                           .c_str(),
                       UsageError);
  std::filesystem::remove_all(folder);
}

TEST_CASE("times are rounded to whole kicks, and a change is reported") {
  const Scene scene = parse_scene(least + "[output]\nsnapshot_every = 0.1\ncheckpoint_every = 1e-9\n"
                                          "[gravity]\nkick_every = 8\n",
                                  "s.toml", {"quality=custom"});
  CHECK(scene.time.end_step == 2000);
  CHECK(scene.output.snapshot_every == 104); // 12.5 intervals: the half goes up
  CHECK(scene.output.checkpoint_every == 8);
  CHECK(
      scene.notices ==
      std::vector<std::string>{
          "output.snapshot_every = 0.1 is rounded to 0.104 orbits (whole kicks, one every 8 steps of 0.001 orbits)",
          "output.checkpoint_every = 1e-09 is rounded to 0.008 orbits (whole kicks, one every 8 steps of 0.001 orbits)",
      });
  // rounding errors of decimal fractions are not reported: 0.7 / 1e-3 is not 700 in binary
  CHECK(parse_scene(changed(least, "end = 2", "end = 0.7"), "s.toml", {"quality=custom"}).notices.empty());
  CHECK(parse_scene(changed(least, "end = 2", "end = 0.0042"), "s.toml", {"quality=custom"}).notices ==
        std::vector<std::string>{"time.end = 0.0042 is rounded to 0.004 orbits (whole steps of 0.001 orbits)"});
}

TEST_CASE("a default schedule is rounded without a notice") {
  const Scene scene = parse_scene(least + "step = 3e-3\n", "s.toml"); // 0.02 is 6.7 steps, and 2 is 666.7
  CHECK(scene.output.series_every == 7);
  CHECK(scene.notices ==
        std::vector<std::string>{"time.end = 2 is rounded to 2.001 orbits (whole steps of 0.003 orbits)"});
  CHECK(parse_scene(least + "[output]\nseries_every = 0\n", "s.toml").output.series_every == 0);
}

TEST_CASE("the resolved scene has every key in force and reads back to an equal scene") {
  const std::string text = R"(
title = "line\nbreak"
planet.preset = "saturn-c-ring"
box.size_in_wavelengths = [40, 41]
[particles]
optical_depth = 0.1
density = 700
sizes = { law = "power", exponent = 3.1, min = 0.3, max = 3 }
[gravity]
kick_every = 3
[time]
step = 1e-3
end = 0.5
)";
  const Scene scene = parse_scene(text, "s.toml");
  const Scene again = parse_scene(scene.resolved, "r.toml");
  CHECK(again.resolved == scene.resolved);
  CHECK(again.notices.empty());
  CHECK(again.title == "line\nbreak");
  CHECK(again.planet.orbital_frequency == scene.planet.orbital_frequency);
  CHECK(again.planet.frequencies.kappa == scene.planet.frequencies.kappa);
  CHECK(again.planet.frequencies.nu == scene.planet.frequencies.nu);
  CHECK(again.size_x == scene.size_x);
  CHECK(again.size_y == scene.size_y);
  CHECK(again.particles.count == scene.particles.count);
  CHECK(again.time.end_step == scene.time.end_step);
  CHECK(again.time.end_step == 501);

  const Scene min_scene = parse_scene(least, "s.toml");
  CHECK(min_scene.resolved == R"(title = ""
quality = "balanced"

[planet]
orbital_frequency = 0.0002
epicyclic_ratio = 1.0
vertical_ratio = 1.0

[box]
size = [100.0, 50.0]

[particles]
count = 300
density = 900.0
velocity_dispersion = 2.0
seed = 1

[particles.sizes]
law = "equal"
radius = 1.0

[collisions]
finder = "certified"
elastic_below_speed = 0.01

[collisions.restitution]
law = "bridges"
scale = 0.34
max_coefficient = 1.0

[time]
step = 0.005
end = 2.0

[output]
series_every = 0.02
stress_every = 0.1
snapshot_every = 0.0
checkpoint_every = 0.0
checkpoint_every_minutes = 10.0
)");
}

} // namespace scene_test
