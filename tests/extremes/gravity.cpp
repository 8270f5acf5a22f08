// Self-gravity that must not count, that gathers all in one aggregate, of a moonlet heavier than the patch, and in
// oblong boxes.
#include "course.hpp"

#include "unit/collision/same_bits.hpp"
#include "unit/collision/spheres.hpp"

#include <keeler/diagnostics/clusters.hpp>
#include <keeler/gravity/direct.hpp>
#include <keeler/initial_conditions/initial.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::extremes {
namespace {

constexpr const char* gravity_section = "Self-gravity";

const std::vector<std::string> small_ring = {"particles.count=300", "box.size=[45,45]", "time.end=0.1"};

std::vector<std::string> with(std::vector<std::string> keys, const std::vector<std::string>& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

std::unique_ptr<gravity::GravitySolver> solver_of(const Scene& scene, const Patch& patch) {
  return make_gravity_solver(*scene.gravity, patch.masses, patch.box.area());
}

gravity::GravityProblem problem_of(const Patch& patch, double newton_g) {
  return {patch.positions, patch.masses, patch.ids, patch.box, patch.offset, newton_g};
}

// With G = 0 no solver accelerates anybody. A field too weak to change a double must leave a run as it is without one:
// masses of 1e-120 kg.
std::vector<Row> without_g() {
  std::vector<Row> rows;
  const Example bare = example("", "equilibrium", small_ring);
  Patch light = initial_patch(bare.scene);
  for (double& mass : light.masses)
    mass *= 1e-120;
  Simulation expected(bare.scene, light);
  for (int k = 0; k < 100; ++k)
    expected.advance();
  for (const std::string solver : {"direct", "tree", "fft", "mesh"}) {
    const Example e = example("G = 0, " + solver, "equilibrium",
                              with(small_ring, {"gravity.solver=" + solver, "gravity.kick_every=1"}));
    const Patch patch = initial_patch(e.scene);
    std::vector<Vec3> accelerations(patch.size(), Vec3(1.0, 1.0, 1.0));
    solver_of(e.scene, patch)->accelerate(problem_of(patch, 0.0), accelerations);
    double largest = 0.0;
    for (const Vec3& a : accelerations)
      largest = std::max(largest, a.norm());
    rows.push_back(exactly(e.state, "largest acceleration", largest, 0.0, "nothing attracts"));
    Simulation simulation(e.scene, light);
    for (int k = 0; k < 100; ++k)
      simulation.advance();
    const bool same = test::same_bits(simulation.state().particles, expected.state().particles);
    rows.push_back(exactly({"masses of 1e-120 kg, " + solver, e.state.made_by + ", masses times 1e-120"},
                           "runs that differ in a bit from that without gravity", same ? 0.0 : 1.0, 0.0,
                           "kicks below the rounding of every element change none"));
  }
  return rows;
}

// Rms of the error over the rms force, against the exact sum.
double force_error(const Scene& scene, const Patch& patch) {
  const gravity::GravityProblem problem = problem_of(patch, newton_g(scene.planet.orbital_frequency));
  std::vector<Vec3> accelerations(patch.size());
  solver_of(scene, patch)->accelerate(problem, accelerations);
  std::vector<std::size_t> all(patch.size());
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k] = k;
  const std::vector<Vec3> exact = sampled_accelerations(problem, all, scene.gravity->images, choose_instruction_set());
  double wrong = 0.0, whole = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    wrong += (accelerations[k] - exact[k]).squaredNorm();
    whole += exact[k].squaredNorm();
  }
  return std::sqrt(wrong / whole);
}

std::vector<Row> force_rows(const std::string& name, const std::vector<std::string>& keys) {
  std::vector<Row> rows;
  for (const std::string solver : {"fft", "tree"}) {
    const Example e = example(fmt::format("{}, {}", name, solver), "a-ring-wakes",
                              with(keys, {"gravity.solver=" + solver,
                                          solver == "fft" ? "gravity.force_error=2e-3" : "gravity.opening_angle=0.6"}));
    rows.push_back(at_most(e.state, "rms error of the force over the rms force",
                           force_error(e.scene, initial_patch(e.scene)), solver == "fft" ? 2e-3 : 4e-3,
                           solver == "fft" ? "the scene asks for it"
                                           : "docs/dev/gravity.md: 1.0e-3 at 0.6, four times for any state"));
  }
  return rows;
}

std::vector<Row> oblong_boxes() {
  std::vector<Row> rows;
  for (const char* size : {"[10,1000]", "[1000,10]"})
    for (const Row& row : force_rows(fmt::format("a box of {} radii", size), {fmt::format("box.size={}", size)}))
      rows.push_back(row);
  return rows;
}

std::vector<Row> moonlet() {
  const std::vector<std::string> keys = {"box.size=[120,160]", "particles.count=3001", "particles.density=900",
                                         "time.end=0.5",
                                         "particles.sizes={law=\"table\", table=[[15.0, 1], [0.7, 3000]]}"};
  const std::string name = "a moonlet of 3.3 times the mass of all others";
  std::vector<Row> rows = force_rows(name, keys);
  const Example e =
      example(name, "a-ring-wakes", with(keys, {"gravity.solver=tree", "gravity.kick_every=1", "time.step=1e-3"}));
  for (const Row& row : rows_of(e.state, follow(e.scene, 500), 1e3))
    rows.push_back(row);
  return rows;
}

// Denser than the tide can pull apart: all gather in one heap, which must neither storm nor sink into itself.
std::vector<Row> aggregate() {
  const Example e =
      example("collapse to one aggregate", "a-ring-wakes",
              {"particles.count=100", "box.size=[28,28]", "particles.density=3000", "particles.velocity_dispersion=1",
               "gravity.solver=direct", "gravity.kick_every=1", "time.step=1e-3", "time.end=5"});
  Simulation simulation(e.scene, initial_patch(e.scene));
  const Course course = follow(simulation, 5000, 100);
  const Patch patch = simulation.patch();
  std::vector<Row> rows = rows_of(e.state, course, 1e5);
  rows.push_back(at_least(e.state, "share of the mass in the largest cluster",
                          diagnostics::analyze_clusters({&patch, 1}).largest_mass_fraction, 0.95,
                          "a few grains may be off the heap"));
  rows.push_back(
      at_most(e.state, "contacts of a particle in the worst step", course.worst_step, 300.0, "a storm has 1e5"));
  return rows;
}

} // namespace

std::vector<Subject> gravity_subjects() {
  using rows::Length;
  return {{"no-g", gravity_section, Length::quick, without_g},
          {"oblong-forces", gravity_section, Length::usual, oblong_boxes},
          {"moonlet", gravity_section, Length::usual, moonlet},
          {"aggregate", gravity_section, Length::usual, aggregate}};
}

} // namespace keeler::extremes
