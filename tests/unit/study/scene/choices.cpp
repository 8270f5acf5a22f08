#include "scene/choices.hpp"

#include <keeler/core/error.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace choices_test {

using namespace keeler;
using namespace keeler::study;

namespace {

Scene scene_with(const std::vector<std::string>& overrides) {
  return parse_scene(R"(
[planet]
orbital_frequency = 1.9565e-4
[box]
size = [60.0, 40.0]
[particles]
optical_depth = 0.3
density = 500.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 1e-3
end = 1.0
)",
                     "scene.toml", overrides);
}

// Returns the scene of a run of the study: with the overrides of a choice.
Scene with(const Scene& scene, const StudyChoice& choice) {
  return parse_scene(scene.resolved, "scene.toml", choice.overrides);
}

std::vector<std::string> names_of(const StudyChoices& choices) {
  std::vector<std::string> names;
  for (const StudyChoice& choice : choices.choices)
    names.push_back(choice.name);
  return names;
}

} // namespace

TEST_CASE("steps divide a kick interval") {
  CHECK(steps_in(4e-3, 1e-3).every == 4);
  CHECK(steps_in(4e-3, 1e-3).step == doctest::Approx(1e-3));
  CHECK(steps_in(1e-3, 3e-4).every == 4);
  CHECK(steps_in(1e-3, 5e-3).every == 1);
  CHECK(steps_in(16e-3, 1e-9).every == 1000);
  CHECK(kicks_of(2.5e-4, 4e-3).every == 16);
  CHECK(kicks_of(8e-3, 4e-3).every == 1);
  CHECK(kicks_of(3e-3, 4e-3).every == 1);
}

TEST_CASE("a study of steps holds the kick interval as far as steps divide it") {
  const Scene scene = scene_with({"gravity.kick_every=4"});
  const StudyChoices all = study_choices(SceneStudyKind::step, scene, false);
  REQUIRE(all.choices.size() == 7);
  CHECK(all.reference == 0);
  for (std::size_t k = 0; k < 6; ++k) {
    const Scene varied = with(scene, all.choices[k]);
    CHECK(varied.time.step == doctest::Approx(0.25e-3 * std::pow(2.0, k)));
    CHECK(varied.time.step * varied.gravity->kick_every == doctest::Approx(k < 5 ? 4e-3 : 8e-3));
  }
  CHECK(with(scene, all.choices[6]).time.automatic);
  const Scene own = scene_with({"time.step=3e-3"});
  CHECK(names_of(study_choices(SceneStudyKind::step, own, true)) ==
        std::vector<std::string>{"step-0.001", "step-0.003", "step-0.004", "step-auto"});
  const Scene plain = scene_with({});
  CHECK(with(plain, study_choices(SceneStudyKind::step, plain, true).choices[1]).time.step == 4e-3);
}

TEST_CASE("a study of kicks has its intervals whatever the scene's step is, and needs gravity") {
  for (const char* const step : {"time.step=1e-3", "time.step=3e-4", "time.step=\"auto\""}) {
    const Scene scene = scene_with({"gravity.solver=\"tree\"", "gravity.kick_every=1", step});
    const StudyChoices all = study_choices(SceneStudyKind::kicks, scene, false);
    const std::size_t own = all.choices.size() - 6; // 3e-4, which is not among the study's
    REQUIRE(own == (scene.time.step == 3e-4 ? 1 : 0));
    if (own == 1)
      CHECK(all.choices.front().name == "kick-0.0003");
    for (std::size_t k = 0; k < 5; ++k) {
      const Scene varied = with(scene, all.choices[own + k]);
      CHECK(varied.time.step * varied.gravity->kick_every == doctest::Approx(1e-3 * std::pow(2.0, k)));
      CHECK(varied.time.step <= 1e-3);
    }
    CHECK(with(scene, all.choices.back()).time.automatic);
  }
  CHECK_THROWS_WITH_AS(study_choices(SceneStudyKind::kicks, scene_with({}), true), doctest::Contains("no self-gravity"),
                       UsageError);
  CHECK_THROWS_AS(study_choices(SceneStudyKind::mesh, scene_with({}), true), UsageError);
}

TEST_CASE("a study of solvers leaves the mesh out where only some rings of images act") {
  const Scene scene = scene_with({"gravity.solver=\"fft\""});
  const StudyChoices all = study_choices(SceneStudyKind::mesh, scene, false);
  CHECK(all.choices.size() == 12);
  CHECK_FALSE(all.reference.has_value());
  CHECK(with(scene, all.choices.front()).gravity->force_error == 3e-4);
  CHECK(with(scene, all.choices[9]).gravity->opening_angle == 0.9);
  CHECK(with(scene, all.choices[10]).gravity->solver == GravitySettings::Solver::mesh);
  CHECK(with(scene, all.choices[11]).gravity->solver == GravitySettings::Solver::direct);
  const Scene large = scene_with({"box.size=[600.0, 400.0]", "gravity.solver=\"fft\""});
  CHECK(names_of(study_choices(SceneStudyKind::mesh, large, false)).back() == "mesh"); // too many for all pairs
  const Scene rings = scene_with({"gravity.solver=\"tree\"", "gravity.images=\"rings\""});
  for (const StudyChoice& choice : study_choices(SceneStudyKind::mesh, rings, false).choices)
    CHECK(with(rings, choice).gravity->solver ==
          (choice.name == "direct" ? GravitySettings::Solver::direct : GravitySettings::Solver::tree));
}

TEST_CASE("boxes have the scene's densities") {
  const Scene scene = scene_with({});
  const StudyChoices all = study_choices(SceneStudyKind::box, scene, false);
  CHECK(names_of(all) == std::vector<std::string>{"box-0.5", "box-0.7", "box-1", "box-1.4", "box-2"});
  CHECK(all.reference == 4);
  for (const StudyChoice& choice : all.choices) {
    const Scene varied = with(scene, choice);
    CHECK(varied.optical_depth() == doctest::Approx(scene.optical_depth()).epsilon(0.01));
    CHECK(varied.size_x / varied.size_y == doctest::Approx(1.5));
  }
  CHECK(with(scene, all.choices[4]).size_x == doctest::Approx(120.0));
}

TEST_CASE("sizes are cut from below; densities and box stay") {
  const char* const power = "particles.sizes={ law = \"power\", exponent = 3, min = 0.3, max = 3 }";
  const char* const table = "particles.sizes={ law = \"table\", table = [[0.5, 100], [1.0, 10], [2.0, 1]] }";
  for (const char* const sizes : {power, table})
    for (const bool gravity : {false, true}) {
      const Scene scene = scene_with(gravity ? std::vector<std::string>{sizes, "gravity.solver=\"tree\""}
                                             : std::vector<std::string>{sizes});
      const StudyChoices all = study_choices(SceneStudyKind::sizes, scene, false);
      REQUIRE(all.choices.size() >= 4);
      CHECK(all.choices.front().name == "whole");
      CHECK(all.choices.back().name == "equal");
      double before = 0.0;
      for (const StudyChoice& choice : all.choices) {
        const Scene varied = with(scene, choice);
        CHECK((choice.name == "equal" || varied.particles.sizes.smallest > before));
        before = varied.particles.sizes.smallest;
        CHECK(varied.size_x == 60.0);
        if (gravity)
          CHECK(varied.surface_density() == doctest::Approx(scene.surface_density()).epsilon(0.05));
        else
          CHECK(varied.optical_depth() == doctest::Approx(scene.optical_depth()).epsilon(0.05));
      }
    }
  CHECK_THROWS_WITH_AS(study_choices(SceneStudyKind::sizes, scene_with({}), true), doctest::Contains("one size, 1 m"),
                       UsageError);
}

} // namespace choices_test
