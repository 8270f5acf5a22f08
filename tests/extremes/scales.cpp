// Steps, sizes, masses, boxes and numbers of particles from one end to the other.
#include "course.hpp"

#include "unit/collision/spheres.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/format.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::extremes {
namespace {

using test::Ring;
using test::Sphere;

constexpr const char* scale_section = "Scales";

std::vector<std::string> thin(double step) {
  return {"particles.count=100", "box.size=[80,80]", "time.end=0.3", fmt::format("time.step={}", step)};
}

Patch state_after(const Scene& scene) {
  Simulation simulation(scene, initial_patch(scene));
  while (simulation.state().step < scene.time.end_step)
    simulation.advance();
  return simulation.patch();
}

// Distance of the nearest images of two places.
double distance(const Vec3& a, const Vec3& b, const Patch& patch) {
  Vec3 d = a - b;
  const double columns = std::round(d.x() / patch.box.size_x);
  d.x() -= columns * patch.box.size_x;
  d.y() = std::remainder(d.y() + columns * patch.offset, patch.box.size_y);
  return d.norm();
}

// Without forces a drift is exact, however long: where particles stand after 0.3 orbit does not depend on the steps.
std::vector<Row> steps() {
  const Example whole = example("steps of 0.3 orbit", "equilibrium", thin(0.3));
  const Patch expected = state_after(whole.scene);
  std::vector<Row> rows = rows_of(whole.state, follow(whole.scene, 1), 5);
  for (const double step : {1e-1, 1e-2, 1e-4, 1e-6}) {
    const Example e = example(fmt::format("steps of {} orbit", step), "equilibrium", thin(step));
    const Patch patch = state_after(e.scene);
    double apart = 0.0;
    for (std::size_t k = 0; k < patch.size(); ++k)
      apart = std::max(apart, distance(patch.positions[k], expected.positions[k], patch));
    rows.push_back(at_most(e.state, "farthest of 100 particles from where one step of 0.3 takes it, radii", apart,
                           1e-11 + 4e-15 * 0.3 / step,
                           "4e-15 a step, half a unit in the last place of Y, which may be of one sign"));
  }
  return rows;
}

std::vector<Row> long_steps() {
  const Example e = example("30 steps of 0.3 orbit", "equilibrium",
                            {"particles.count=300", "box.size=[97,97]", "time.step=0.3", "time.end=9"});
  return rows_of(e.state, follow(e.scene, 30, 30), 1000);
}

std::vector<Row> sizes() {
  const Example e =
      example("sizes 1 : 10⁴", "equilibrium",
              {"particles.count=4001", "box.size=[25,25]", "time.end=1", "particles.velocity_dispersion=20",
               "particles.sizes={law=\"table\", table=[[10.0, 1], [0.001, 4000]]}"});
  return rows_of(e.state, follow(e.scene, 1000), 100);
}

// Among equal spheres. Where many are about, two heavy ones may close in on a light one: a refusal, there.
std::vector<Row> masses() {
  const Example e =
      example("masses 1 : 10⁹", "equilibrium", {"particles.count=300", "box.size=[140,140]", "time.end=10"});
  Patch patch = initial_patch(e.scene);
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.masses[k] = std::pow(10.0, 9.0 * static_cast<double>(k) / static_cast<double>(patch.size() - 1));
  Simulation simulation(e.scene, patch);
  const State state{e.state.name, e.state.made_by + ", masses 10^(9 k/(N - 1)) kg"};
  return rows_of(state, follow(simulation, 10'000), 1e3);
}

// Two particles meet in several images.
std::vector<Row> small_boxes() {
  AgainstPlain course;
  for (const double side : {2.2, 3.0, 5.0}) {
    std::vector<Sphere> spheres;
    for (int k = 0; k < 4; ++k)
      spheres.push_back({{0.1 * k, 0.3, 2.1 * k - 3.0}, {1.0, 0.5 * k, -0.3 * k}});
    Ring ring(test::patch_of(spheres, side, side), {}, two_pi * 1e-2);
    course += against_plain(ring, {}, 200);
  }
  return rows_of({"boxes of 2.2, 3 and 5 radii", "four spheres, 200 steps of 1e-2 orbit in each"}, course, 1e-13, 500);
}

std::vector<Row> large_box() {
  const Example e = example("a box of 10⁵ radii", "equilibrium",
                            {"particles.optical_depth=1e-4", "box.size=[1e5,1e5]", "time.step=1e-2", "time.end=2"});
  return rows_of(e.state, follow(e.scene, 200, 2), 100);
}

std::vector<Row> runs_in_oblong_boxes() {
  std::vector<Row> rows;
  for (const char* size : {"[10,1000]", "[1000,10]"}) {
    const Example e = example(fmt::format("a box of {} radii", size), "equilibrium",
                              {fmt::format("box.size={}", size), "time.end=5"});
    for (const Row& row : rows_of(e.state, follow(e.scene, 5000), 1e4))
      rows.push_back(row);
  }
  return rows;
}

// No particle, one, two and three, without gravity and with each solver.
std::vector<Row> few() {
  std::vector<Row> rows;
  for (const std::string solver : {"none", "direct", "tree", "fft"})
    for (int count = 0; count <= 3; ++count) {
      const State state{
          fmt::format("{}, gravity: {}", pluralize(static_cast<std::size_t>(count), "particle"), solver),
          "spheres of 1 m and 900 kg/m^3 one above the other in a box of 20 x 20 m, 1000 steps of 1e-2 orbit"};
      const Scene scene = parse_scene(
          "planet.preset = \"saturn-a-ring\"\nbox.size = [20, 20]\nparticles = { count = 1, density = 900, sizes = { "
          "law = \"equal\", radius = 1.0 } }\ntime = { step = 1e-2, end = 10.0 }\n" +
              (solver == "none" ? "" : fmt::format("gravity.solver = \"{}\"\n", solver)),
          "few");
      std::vector<Sphere> spheres;
      for (int k = 0; k < count; ++k)
        spheres.push_back({{0.0, 0.0, 2.5 * k}, {0.0, 0.0, k == 0 ? 1.0 : 0.0}, 1.0, 4.0 / 3.0 * pi * 900.0});
      Simulation simulation(scene, test::patch_of(spheres, 20.0, 20.0, scene.planet.frequencies));
      double overlap = 0.0;
      for (int k = 0; k < 1000; ++k) {
        simulation.advance();
        overlap = std::max(overlap, cells::largest_overlap(simulation.patch()).depth);
      }
      const CollisionTally& tally = simulation.state().collisions;
      const auto contacts = static_cast<double>(tally.fast + tally.slow);
      rows.push_back(count < 2 ? exactly(state, "contacts", contacts, 0.0, "there is no partner")
                               : at_least(state, "contacts", contacts, 10.0, "they swing through the same plane"));
      rows.push_back(at_most(state, "deepest overlap over the radius sum", overlap, 1e-13, "rounding of places"));
      if (count == 1) {
        const double nu = scene.planet.frequencies.nu, z = std::sin(nu * two_pi * simulation.orbits()) / nu;
        rows.push_back(at_most(state, "distance from its exact orbit, m",
                               (simulation.patch().positions[0] - Vec3(0, 0, z)).norm(), 1e-12,
                               "rounding in 1000 steps: its own images pull evenly"));
      }
    }
  return rows;
}

} // namespace

std::vector<Subject> scale_subjects() {
  using rows::Length;
  return {{"steps", scale_section, Length::usual, steps},
          {"long-steps", scale_section, Length::quick, long_steps},
          {"sizes", scale_section, Length::usual, sizes},
          {"masses", scale_section, Length::quick, masses},
          {"small-boxes", scale_section, Length::quick, small_boxes},
          {"large-box", scale_section, Length::usual, large_box},
          {"oblong-boxes", scale_section, Length::usual, runs_in_oblong_boxes},
          {"few", scale_section, Length::quick, few}};
}

} // namespace keeler::extremes
