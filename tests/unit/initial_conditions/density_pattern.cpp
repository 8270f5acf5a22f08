#include <keeler/scene/scene.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <complex>

namespace density_pattern_test {

using namespace keeler;

namespace {

Scene scene_with(const std::string& pattern, const std::string& amount = "optical_depth = 0.4") {
  return parse_scene(R"(
[planet]
orbital_frequency = 1.95e-4
[box]
size = [240.0, 160.0]
[particles]
density = 900.0
sizes = { law = "equal", radius = 1.0 }
)" + amount + "\n" + pattern +
                         "\n[time]\nend = 1.0\n",
                     "s.toml");
}

// Returns Σ/⟨Σ⟩ between two x.
double density_between(const Patch& patch, double low, double high) {
  double count = 0.0;
  for (const Vec3& place : patch.positions)
    count += place.x() >= low && place.x() < high;
  return count / static_cast<double>(patch.size()) * patch.box.size_x / (high - low);
}

// Returns the complex amplitude of Σ/⟨Σ⟩ − 1, as in amplitude × exp(i k·r).
std::complex<double> wave(const Patch& patch, int nx, int ny) {
  std::complex<double> sum = 0.0;
  for (const Vec3& place : patch.positions)
    sum += std::polar(2.0, -two_pi * (nx * place.x() / patch.box.size_x + ny * place.y() / patch.box.size_y));
  return sum / static_cast<double>(patch.size());
}

std::string fault(const std::string& pattern) {
  try {
    scene_with(pattern);
  } catch (const UsageError& error) {
    return error.what();
  }
  return {};
}

} // namespace

TEST_CASE("a pattern has the mean 1, and nowhere more than its peak") {
  for (const scene::DensityPattern& p :
       {scene::DensityPattern{}, scene::DensityPattern{.size_x = 30, .size_y = 20, .low = -4, .high = 9, .factor = 3},
        scene::DensityPattern{.size_x = 30, .size_y = 20, .contrast = 0.7, .waves_x = 3, .waves_y = 1},
        scene::DensityPattern{
            .size_x = 30, .size_y = 20, .low = -4, .high = 9, .factor = 0.2, .contrast = 0.7, .waves_x = 2},
        scene::DensityPattern{.size_x = 30,
        .size_y = 20,
        .low = -4,
        .high = 9,
        .factor = 3,
        .contrast = 1,
        .waves_x = 3,
        .waves_y = -2}}) {
    constexpr int cells = 600;
    double sum = 0.0, largest = 0.0;
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const double density = p.relative(p.size_x * ((i + 0.5) / cells - 0.5), p.size_y * ((j + 0.5) / cells - 0.5));
        sum += density;
        largest = std::max(largest, density);
      }
    CHECK(sum / cells / cells == doctest::Approx(1.0).epsilon(1e-5)); // midpoint rule; no cell straddles the step
    CHECK(largest <= p.peak() * (1.0 + 1e-12));
  }
}

TEST_CASE("a step has the density that is asked for on both sides, and the scene's number of particles") {
  const Scene scene = scene_with("density_step = { between = [-30.0, 50.0], factor = 3.0 }");
  const Patch patch = initial_patch(scene);
  CHECK(patch.size() == scene_with("").particles.count);
  CHECK(cells::largest_overlap(patch).depth == 0.0);
  const double beside = 1.0 / (1.0 + 2.0 * 80.0 / 240.0); // the mean equals the scene's
  // 1 m about the edges is left out: particles push each other apart. Noise of counts: 1/√N of 1500 to 3000
  CHECK(density_between(patch, -29.0, 49.0) == doctest::Approx(3.0 * beside).epsilon(3.0 / std::sqrt(2900.0)));
  CHECK(density_between(patch, -119.0, -31.0) == doctest::Approx(beside).epsilon(3.0 / std::sqrt(1000.0)));
  CHECK(density_between(patch, 51.0, 119.0) == doctest::Approx(beside).epsilon(3.0 / std::sqrt(800.0)));
  const Patch gap = initial_patch(scene_with("density_step = { between = [10.0, 40.0], factor = 0.0 }"));
  CHECK(density_between(gap, 12.0, 38.0) == 0.0);
  CHECK(density_between(gap, -119.0, 8.0) == doctest::Approx(240.0 / 210.0).epsilon(3.0 / std::sqrt(2800.0)));
}

TEST_CASE("a wake has the amplitude and the place that are asked for, and trails") {
  const Scene scene = scene_with("wake = { contrast = 0.6, wavelength = 62.0, pitch = 22.0 }");
  const scene::DensityPattern& pattern = scene.particles.pattern;
  CHECK(pattern.waves_x == 4);
  CHECK(pattern.waves_y == 1);
  CHECK(pattern.wavelength() == doctest::Approx(1.0 / std::hypot(4.0 / 240.0, 1.0 / 160.0)).epsilon(1e-14));
  REQUIRE(scene.notices.size() == 1);
  CHECK(scene.notices[0] ==
        "the wake has a wavelength of 56.18 m and a pitch of 20.56 degrees (4 x 1 waves fit the box)");
  CHECK(parse_scene(scene.resolved, "r.toml").notices.empty());
  CHECK(parse_scene(scene.resolved, "r.toml").resolved == scene.resolved);
  // outward along a crest leads backward along the orbit
  CHECK(pattern.relative(10.0, -10.0 / std::tan(pattern.pitch() * pi / 180.0)) ==
        doctest::Approx(pattern.relative(0.0, 0.0)).epsilon(1e-12));

  const Patch patch = initial_patch(scene);
  CHECK(cells::largest_overlap(patch).depth == 0.0);
  const double noise = 2.0 / std::sqrt(static_cast<double>(patch.size()));
  CHECK(std::abs(wave(patch, 4, 1) - 0.6) < 3.0 * noise);
  CHECK(std::abs(wave(patch, 4, -1)) < 3.0 * noise);
  CHECK(std::abs(wave(patch, 8, 2)) < 3.0 * noise); // a cosine, no other shape
  const Patch plain = initial_patch(scene_with(""));
  CHECK(std::abs(wave(plain, 4, 1)) < 3.0 * noise);

  const int before = threads();
  set_threads(before == 1 ? 3 : 1);
  CHECK(initial_patch(scene).positions == patch.positions);
  set_threads(before);
}

TEST_CASE("a pattern that the box does not hold is told") {
  CHECK(fault("density_step = { between = [-30.0, 130.0], factor = 2.0 }")
            .find("particles.density_step.between is [-30, 130] (it must be two rising x within the box, from -120 to "
                  "120, and "
                  "not all of it)") != std::string::npos);
  CHECK(fault("density_step = { between = [30.0, -30.0], factor = 2.0 }").find("two rising x") != std::string::npos);
  CHECK(fault("density_step = { between = [-120.0, 120.0], factor = 2.0 }").find("not all of it") != std::string::npos);
  CHECK(fault("density_step = { between = [-30.0, 30.0] }").find("particles.density_step.factor is missing") !=
        std::string::npos);
  CHECK(fault("wake = { contrast = 0.5, wavelength = 1000.0 }").find("no wave fits the box of 240 m x 160 m") !=
        std::string::npos);
  CHECK(fault("wake = { contrast = 0.5, wavelength = 1.5 }").find("shorter than the largest particle (2 m across)") !=
        std::string::npos);
  CHECK(fault("wake = { contrast = 1.5, wavelength = 60.0 }").find("particles.wake.contrast is 1.5") !=
        std::string::npos);
  CHECK_THROWS_AS(scene_with("wake = { contrast = 0.9, wavelength = 60.0 }", "optical_depth = 2.0"), UsageError);
}

} // namespace density_pattern_test
