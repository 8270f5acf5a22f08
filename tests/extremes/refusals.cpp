// Where Keeler refuses: the exit code and the words of its message.
#include "rows.hpp"

#include "unit/collision/ring.hpp"
#include "unit/collision/spheres.hpp"

#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <fmt/format.h>

#include <limits>

namespace keeler::extremes {
namespace {

using test::Ring;
using test::Sphere;

constexpr const char* file = "/examples/equilibrium/scene.toml";

Scene scene_with(const std::vector<std::string>& overrides) {
  return load_scene(std::string(KEELER_SOURCE_DIR) + file, overrides);
}

struct Refusal {
  const char* what;
  std::vector<std::string> overrides, words;
};

std::vector<Row> refused_scenes() {
  const std::string small = "5e-324";
  std::vector<Row> rows;
  for (const Refusal& r : std::vector<Refusal>{
           {"steps above 0.3 orbit", {"time.step=0.31"}, {"time.step is 0.31", "from 1e-9 to 0.3"}},
           {"steps of nothing", {"time.step=0"}, {"time.step is 0", "from 1e-9 to 0.3"}},
           {"no particle", {"particles.count=0"}, {"particles.count is 0", "a whole number from 1 to 1e9"}},
           {"no shear: κ = 2", {"planet.epicyclic_ratio=2"}, {"planet.epicyclic_ratio is 2", "below 2"}},
           {"ν = 0", {"planet.vertical_ratio=0"}, {"planet.vertical_ratio is 0", "from 0.1 to 100"}},
           {"τ = −0", {"particles.optical_depth=-0.0"}, {"particles.optical_depth is -0", "above 0"}},
           {"a denormal radius", {"particles.sizes.radius=" + small}, {"particles.sizes.radius", "from 1e-6"}},
           {"ε above 1", {"collisions.restitution.value=1.1"}, {"restitution.value is 1.1", "from 0 to 1"}},
           {"filling above 0.62",
            {"particles.optical_depth=5"},
            {"too dense", "at most 0.62", "raise velocity_dispersion"}},
           {"a box below a particle", {"box.size=[1.5,100]"}, {"is smaller than a particle", "enlarge the box"}},
           {"aspect above 1 : 1000", {"box.size=[3,3300]"}, {"1000"}}})
    rows.push_back(refused(
        {r.what, fmt::format("keeler check examples/equilibrium/scene.toml --set '{}'", r.overrides[0])},
        [&] { scene_with(r.overrides); }, 2, r.words));
  return rows;
}

void start_from(const std::vector<Sphere>& spheres, double side) {
  const Scene scene = scene_with({});
  Simulation simulation(scene, test::patch_of(spheres, side, side));
  for (int k = 0; k < 10; ++k)
    simulation.advance();
}

// A closed row without gaps: what hits it runs around it for ever in no time.
void storm() {
  std::vector<Sphere> row;
  for (int k = 0; k < 3; ++k)
    row.push_back({{0, 2.0 * k - 3.0, 0}, {0, k == 0 ? 1.0 : 0.0, 0}});
  collision::CollisionSettings settings;
  settings.restitution = collision::constant_restitution(1.0);
  Ring ring(test::patch_of(row, 20.0, 6.0), settings, two_pi * 1e-3);
  ring.advance();
}

// A light sphere between two heavy ones that close in: each hit takes away a part of their momentum as small as its
// mass, and restitution below 1 keeps it from growing fast.
void squeeze() {
  const Scene scene = scene_with({});
  Simulation simulation(
      scene, test::patch_of({{{0, -2.1, 0}, {0, 10, 0}, 1.0, 1e9}, {{0, 0, 0}}, {{0, 2.1, 0}, {0, -10, 0}, 1.0, 1e9}},
                            50.0, 50.0));
  for (int k = 0; k < 10; ++k)
    simulation.advance();
}

std::vector<Row> refused_states() {
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  return {refused({"a jammed row without any room, hit", "three spheres that close a box of three diameters"}, storm, 3,
                  {"event storm", "particle", "collisions.elastic_below_speed"}),
          refused({"a sphere between two 10⁹ times as heavy",
                   "three in a row along the orbit, closing at 10 m an orbit's radian, ε 0.5"},
                  squeeze, 3, {"event storm", "particle 1", "collisions.elastic_below_speed"}),
          refused({"an overlap at the start", "two spheres, 1e-7 of two radii too near"},
                  [] {
                    start_from({{{0, 0, 0}}, {{0, 0, 2.0 - 2e-7}}}, 50.0);
                  },
                  3, {"particles 0 and 1", "overlap by 1.00e-07"}),
          refused({"a place that is not finite", "a sphere at z = infinity"},
                  [&] {
                    start_from({{{0, 0, 0}}, {{0, 0, infinity}}}, 50.0);
                  },
                  3, {"particle 1", "finite"}),
          refused({"a velocity that is no number", "a sphere of velocity NaN"},
                  [&] {
                    start_from({{{0, 0, 0}}, {{0, 0, 3}, {nan, 0, 0}}}, 50.0);
                  },
                  3, {"particle 1", "finite"}),
          refused({"a mass of 0", "a sphere of mass 0"},
                  [] {
                    start_from({{{0, 0, 0}, {0, 0, 0}, 1.0, 0.0}}, 50.0);
                  },
                  3, {"particle 0", "mass"}),
          refused({"a box below the particles of a start", "a sphere of 1 m in 1.9 x 1.9 m"},
                  [] {
                    start_from({{{0, 0, 0}}}, 1.9);
                  },
                  2, {"smaller than its largest particle", "start from another state"}),
          refused({"orbits across more than 300 boxes in a step", "two spheres at 1e8 m an orbit's radian"},
                  [] {
                    start_from({{{0, 0, 0}, {1e8, 0, 0}}, {{0, 0, 3}}}, 50.0);
                  },
                  3, {"particles cross the box", "take a shorter step, a larger box or slower particles"})};
}

} // namespace

std::vector<Subject> refusal_subjects() {
  constexpr const char* section = "Refused, with a message";
  return {{"refused-scenes", section, rows::Length::quick, refused_scenes},
          {"refused-states", section, rows::Length::quick, refused_states}};
}

} // namespace keeler::extremes
