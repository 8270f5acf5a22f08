// The numbers that `keeler check` prints.
#include "unit/scene/scenes.hpp"

#include <keeler/advice/derived.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace derived_test {

using namespace keeler;
using namespace keeler::advice;
using namespace keeler::test;

TEST_CASE("the A-ring example has the numbers of the design") {
  const Scene scene = load_scene(KEELER_SOURCE_DIR "/examples/a-ring-wakes/scene.toml");
  const Derived d = derive(scene);
  CHECK(scene.notices.empty());
  CHECK(d.particle_count == doctest::Approx(9600).epsilon(0.002)); // "about 9600"
  CHECK(d.lambda_cr == doctest::Approx(61.4).epsilon(0.002));      // "61 m"
  CHECK(d.surface_density == doctest::Approx(400).epsilon(1e-4));  // half a particle of 9600
  CHECK(d.optical_depth == doctest::Approx(0.5).epsilon(1e-4));
  CHECK(d.hill_parameter == doctest::Approx(0.82 * std::cbrt(600.0 / 900) * 1.3).epsilon(3e-4));
  CHECK(d.steps == 2400);
  CHECK(d.memory_mb == doctest::Approx(39.0).epsilon(0.05)); // 33 MB and some 650 bytes a particle
}

TEST_CASE("the estimated memory includes the meshes") {
  const auto megabytes = [](const std::string& gravity) {
    return derive(parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [1000, 1000]
[particles]
count = 20000
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
end = 1.0
)" + gravity,
                              "scene"))
        .memory_mb;
  };
  const double without = megabytes("");
  CHECK(without < 60.0);
  // 12 · 10⁶ waves: 2²⁷ nodes
  const double nodes = 0x1p27, radial = megabytes("[gravity]\nsolver = 'axisymmetric'\nshortest_wavelength = 1e-4\n");
  CHECK(radial - without > 1e-6 * 24 * nodes); // one number a node, half a complex one, a whole one on each thread
  CHECK(radial - without < 1e-6 * 64 * nodes * threads());
  // at most 2²¹ nodes and 64 per particle, 8 bytes each
  const double fine = megabytes("[gravity]\nsolver = 'mesh'\nmesh_spacing = 0.1\n"),
               coarse = megabytes("[gravity]\nsolver = 'mesh'\n");
  CHECK(fine - coarse > 5.0);
  CHECK(fine - coarse < 1e-6 * 16 * (0x1p21 + 64 * 20000));
}

TEST_CASE("a rank's memory is that of its particles, and of all for solvers that gather them") {
  const auto scene_with = [](const std::string& solver) {
    return parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [1000, 1000]
[particles]
count = 100000
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
end = 1.0
[gravity]
solver = ')" + solver + "'\n" +
                           (solver == "axisymmetric" ? "shortest_wavelength = 1e-3\n" : ""),
                       "scene");
  };
  constexpr std::size_t all = 100000, quarter = all / 4;
  const auto whole = [&](const std::string& solver) { return rank_memory(scene_with(solver), all, all); };
  const auto part = [&](const std::string& solver) { return rank_memory(scene_with(solver), quarter, all); };
  CHECK(1e-6 * whole("tree") + 33.0 == doctest::Approx(derive(scene_with("tree")).memory_mb));
  // a tree of all particles needs some 200 bytes each on every rank; measured on four: docs/dev/ranks.md
  CHECK(part("tree") > 380.0 * all);
  CHECK(part("tree") < 500.0 * all);
  CHECK(part("direct") > 0.25 * whole("direct") + 40.0 * all);
  CHECK(part("fft") < 0.3 * whole("fft"));
  CHECK(part("axisymmetric") > 0.25 * whole("axisymmetric"));
  // `auto` sums few particles directly: what counts is the number of all
  constexpr std::size_t few = 10;
  CHECK(rank_memory(scene_with("auto"), few, all) == rank_memory(scene_with("fft"), few, all));
}

TEST_CASE("the equilibrium example has about 1500 particles and no gravity") {
  const Scene scene = load_scene(KEELER_SOURCE_DIR "/examples/equilibrium/scene.toml");
  CHECK(std::fabs(static_cast<double>(scene.particles.count) - 1500) < 20);
  CHECK(!scene.gravity);
  CHECK(scene.time.end_step == 15000);
}

TEST_CASE("with a start file only the steps are known") {
  const Scene scene =
      parse_scene("planet.preset = \"saturn-b-ring\"\ntime.end = 1\nstart.from = \"wakes.hdf\"\n", "s.toml");
  CHECK(!derive(scene).particles_known);
  CHECK(derive(scene).steps == scene.time.end_step);
  // sizes and box are unknown
  CHECK(rank_memory(scene, 1000, 1000) > 400.0 * 1000);
  CHECK(rank_memory(scene, 1000, 1000) < 700.0 * 1000);
}

TEST_CASE("dense rings and long steps need more memory") {
  const Scene example = load_scene(KEELER_SOURCE_DIR "/examples/equilibrium/scene.toml");
  const auto bytes = [&](double depth, double step) {
    Scene scene = example;
    const double scale = std::sqrt(example.optical_depth() / depth);
    scene.size_x *= scale;
    scene.size_y *= scale;
    scene.time.step = step;
    return rank_memory(scene, 1000, 1000) / 1000;
  };
  // measured: docs/dev/estimate.md
  CHECK(bytes(0.5, 1e-2) > 450);
  CHECK(bytes(1.0, 1e-2) > 583);
  CHECK(bytes(2.0, 1e-3) > 629);
  CHECK(bytes(2.0, 1e-2) > 930);
  CHECK(bytes(2.0, 1e-2) < 1.2 * 930);
}

} // namespace derived_test
