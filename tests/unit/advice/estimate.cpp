#include "unit/scene/scenes.hpp"

#include <keeler/advice/estimate.hpp>
#include <keeler/advice/grain_piles.hpp>
#include <keeler/scene/contact_rates.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

namespace estimate_test {

using namespace keeler;
using namespace keeler::advice;
using namespace keeler::test;

namespace {

// Adds: steps of 1e-3 orbit, each with a kick by the tree.
std::vector<std::string> custom(std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(), "quality=custom");
  return overrides;
}

Scene with(const std::vector<std::string>& overrides) {
  return parse_scene(least, "s.toml", custom(overrides));
}

Scene a_ring(const std::vector<std::string>& overrides = {}) {
  return load_scene(KEELER_SOURCE_DIR "/examples/a-ring-wakes/scene.toml", custom(overrides));
}

// Checks a value within a factor.
void check_near(double value, double expected, double factor) {
  CAPTURE(value);
  CAPTURE(expected);
  CHECK(value < expected * factor);
  CHECK(value > expected / factor);
}

} // namespace

TEST_CASE("grains collect on a moonlet and in aggregates, and dominate the cost") {
  const Scene scene = load_scene(KEELER_SOURCE_DIR "/examples/moonlet/scene.toml");
  // pairs at rest after 0.25, 0.5 and 1 orbit, 2.5 per grain
  check_near(GrainPiles(scene).grains(0.25), 1775 / 2.5, 1.5);
  check_near(GrainPiles(scene).grains(0.5), 5379 / 2.5, 1.5);
  check_near(GrainPiles(scene).grains(1.0), 10757 / 2.5, 1.5);
  CHECK(std::string(estimate_run(scene).dominating()) == "drift");
  check_near(estimate_run(scene).total(), 102.0 * reference_pair_ns / 9.0, 2.0);
  CHECK(GrainPiles(a_ring()).grains(3.0) == 0.0);
  const Scene ring = load_scene(KEELER_SOURCE_DIR "/examples/aggregates/scene.toml");
  check_near(GrainPiles(ring).grains(2.0), 481 / 2.5, 1.5);
}

TEST_CASE("a mesh costs more for a layer that is thick compared with its particles' distances") {
  const auto gravity = [](const std::vector<std::string>& overrides) {
    const Scene scene = a_ring(overrides);
    return estimate_run(scene).gravity / static_cast<double>(scene.particles.count);
  };
  const std::string fft = "gravity={solver=\"fft\"}";
  CHECK(gravity({fft, "particles.velocity_dispersion=20"}) > 1.5 * gravity({fft}));
  CHECK(gravity({fft, "particles.sizes={law=\"power\",exponent=3,min=0.2,max=10}"}) > 1.2 * gravity({fft}));
}

TEST_CASE("the estimate follows settings that make gravity expensive") {
  // docs/dev/estimate.md: times of 25,000 spheres, of the tree 1000, over those of the first setting
  const auto gravity = [](std::size_t count, const std::string& choice) {
    const double side = std::sqrt(6.4 * static_cast<double>(count));
    return estimate_run(
               with({fmt::format("particles.count={}", count), fmt::format("box.size=[{0},{0}]", side), choice}))
        .gravity;
  };
  const auto mesh = [&](double spacing) {
    return gravity(25000, fmt::format("gravity={{solver=\"mesh\",mesh_spacing={}}}", spacing));
  };
  check_near(mesh(0.8) / mesh(1.6), 3.3, 1.5);
  check_near(mesh(0.1) / mesh(1.6), 10.0, 1.5);
  const auto waves = [&](double shortest) {
    return gravity(25000, fmt::format("gravity={{solver=\"axisymmetric\",shortest_wavelength={}}}", shortest));
  };
  check_near(waves(0.01) / waves(1.0), 4.0, 2.0);
  check_near(waves(0.001) / waves(1.0), 123.0, 2.0);
  const auto tree = [&](double angle) {
    return gravity(1000, fmt::format("gravity={{solver=\"tree\",opening_angle={}}}", angle));
  };
  check_near(tree(0.1) / tree(0.7), 2.5, 5.0); // the formula gives 12
  check_near(tree(0.01) / tree(0.7), 8.9, 2.0);
}

TEST_CASE("the estimate follows the settings") {
  const RunEstimate one = estimate_run(with({}));
  const RunEstimate longer = estimate_run(with({"time.end=4"}));
  CHECK(longer.drift == doctest::Approx(2.0 * one.drift));
  CHECK(longer.start == one.start);
  CHECK(one.gravity == 0.0);
  const RunEstimate larger = estimate_run(with({"particles.count=600", "box.size=[200, 50]"})); // the same depth
  check_near(larger.drift, 2.0 * one.drift, 1.1); // and a little more, as caches are left
  CHECK(larger.drift > 2.0 * one.drift);
  const RunEstimate finer = estimate_run(with({"time.step=1e-4"})); // ten times the steps, with as many contacts
  CHECK(finer.drift > 2.0 * one.drift);
  CHECK(finer.drift < 10.0 * one.drift);
  CHECK(estimate_run(with({"output.snapshot_every=0.001"})).output > 100.0 * one.output);
  CHECK(estimate_run(with({"output.series_every=0.001"})).output > 2.0 * one.output);

  const RunEstimate kicked = estimate_run(a_ring());
  CHECK(estimate_run(a_ring({"gravity.kick_every=5"})).gravity == doctest::Approx(kicked.gravity / 5.0));
  CHECK(estimate_run(a_ring({"gravity.opening_angle=0.3"})).gravity > 1.5 * kicked.gravity);
  const std::vector<std::string> direct = {"gravity={solver=\"direct\"}"};
  const std::vector<std::string> direct_larger = {"gravity={solver=\"direct\"}", "box.size_in_wavelengths=[8, 8]"};
  check_near(estimate_run(a_ring(direct_larger)).gravity, 16.0 * estimate_run(a_ring(direct)).gravity, 1.01);
}

TEST_CASE("the estimate is proportional to the yardstick, and its parts sum up to the total") {
  const RunEstimate here = estimate_run(a_ring()), there = estimate_run(a_ring(), 2.0 * reference_pair_ns);
  double sum = 0.0;
  for (std::size_t k = 0; k < here.parts().size(); ++k) {
    CHECK(there.parts()[k].seconds == doctest::Approx(2.0 * here.parts()[k].seconds));
    sum += here.parts()[k].seconds;
  }
  CHECK(here.total() == doctest::Approx(sum));
  CHECK(std::string(here.dominating()) == "gravity");
  CHECK(std::string(estimate_run(a_ring({"gravity.kick_every=20"})).dominating()) == "drift");
}

TEST_CASE("a moonlet's area adds few contacts and no levels of cells") {
  // 10,000 grains of 1 m and as much area in one sphere of 100 m: grains meet 1.5 times τ = 0.5, not twice
  std::vector<double> radii(10000, 1.0);
  radii.push_back(100.0);
  Scene scene = with({"particles.count=10001", "box.size=[251, 251]"});
  const RunEstimate grains = estimate_run(scene);
  const double rate = scene_contacts(scene).smooth.fast;
  scene.particles.sizes = particles::listed_sizes(radii);
  check_near(scene_contacts(scene).smooth.fast, 1.5 * rate, 1.15);
  check_near(estimate_run(scene).drift, 2.0 * grains.drift, 1.5);
}

TEST_CASE("the cost of a start grows with the number of particles and with the optical depth") {
  const auto start = [](const std::vector<std::string>& overrides) {
    return estimate_run(load_scene(KEELER_SOURCE_DIR "/examples/a-ring-wakes/scene.toml", overrides)).start;
  };
  const double once = start({});
  CHECK(start({"box.size_in_wavelengths=[8, 8]"}) == doctest::Approx(4.0 * once).epsilon(1e-3));
  CHECK(start({"particles.optical_depth=1.0", "box.size=[100, 100]"}) >
        2.2 * start({"particles.optical_depth=0.5", "box.size=[100, 100]"}));
}

TEST_CASE("expensive settings are named with their cost") {
  CHECK(expensive_settings(a_ring()).empty());
  CHECK(expensive_settings(a_ring({"box.size=[100,400]"})).empty());
  CHECK(expensive_settings(with({"collisions.restitution={law=\"constant\",value=0.3}"})).empty());
  const auto says = [](const Scene& scene, const char* words) {
    const std::vector<std::string> lines = expensive_settings(scene);
    REQUIRE(lines.size() == 1);
    CAPTURE(lines[0]);
    CHECK(lines[0].find(words) != std::string::npos);
  };
  says(a_ring({"box.size=[10,10000]", "gravity.solver=tree"}), "times more in this box of 1 : 1000");
  says(a_ring({"box.size=[10000,10]", "gravity.solver=tree"}), "in this box of 1 : 1000");
  CHECK(expensive_settings(a_ring({"box.size=[10,10000]", "gravity.solver=fft"})).empty());
  says(with({"collisions.restitution={law=\"constant\",value=0}"}), "a restitution of 0 makes the drift cost about");
}

} // namespace estimate_test
