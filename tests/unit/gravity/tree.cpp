#include "tree.hpp"

#include "clumped_state.hpp"

#include <keeler/gravity/direct.hpp>

#include <doctest/doctest.h>

namespace tree_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

std::vector<Vec3> by_direct(const ClumpedState& state, int rings = 1) {
  DirectSolver solver({rings, true}, choose_instruction_set());
  return accelerations(solver, state.problem());
}

std::vector<Vec3> by_tree(const ClumpedState& state, double opening_angle, int rings = 1) {
  TreeSolver solver(opening_angle, {rings, true}, choose_instruction_set());
  return accelerations(solver, state.problem());
}

} // namespace

TEST_CASE("the tree's error in a clumped state is what its opening angle promises") {
  for (const double size_range : {1.0, 1000.0}) {
    const ClumpedState state = clumped_state(4000, 1, size_range);
    const std::vector<Vec3> exact = by_direct(state);
    const double at_07 = rms_error(by_tree(state, 0.7), exact);
    const double at_05 = rms_error(by_tree(state, 0.5), exact);
    const double at_03 = rms_error(by_tree(state, 0.3), exact);
    MESSAGE("radii 1:" << size_range << ", rms error at 0.7, 0.5, 0.3: " << at_07 << " " << at_05 << " " << at_03);
    CHECK(at_07 <= 5e-3);
    CHECK(at_05 <= 1e-3);
    CHECK(at_05 < at_07 / 2);
    CHECK(at_03 < at_05 / 2);
  }
}

TEST_CASE("the tree conserves momentum") {
  const ClumpedState state = clumped_state(4000, 1);
  const std::vector<Vec3> a = by_tree(state, 0.7);
  Vec3 sum = Vec3::Zero();
  double whole = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += state.masses[k] * a[k];
    whole += state.masses[k] * a[k].norm();
  }
  CHECK(sum.norm() < 1e-13 * whole); // the mean is subtracted; rounding of 4000 terms
}

TEST_CASE("with more rings and at other offsets the tree still follows the direct sum") {
  ClumpedState state = clumped_state(1000, 4);
  for (const double part : {0.0, 0.5, 0.9})
    for (const int rings : {0, 2}) {
      state.offset = part * state.box.size_y;
      CHECK(rms_error(by_tree(state, 0.5, rings), by_direct(state, rings)) < 1e-3);
    }
}

TEST_CASE("a closed opening angle gives the direct sum to single precision") {
  const ClumpedState state = clumped_state(1500, 6, 10.0);
  const std::vector<Vec3> exact = by_direct(state);
  CHECK(rms_error(by_tree(state, 0.0), exact) < 1e-6);
  CHECK(rms_error(by_tree(state, 1e-9), exact) < 1e-6);
}

TEST_CASE("touching spheres attract by Newton's law, wherever they are and whatever their sizes") {
  for (const double radius : {100.0, 1.0, 0.1, 1e-3})
    for (const Vec3& at : {Vec3(0.3, 0.2, 0.1), Vec3(-4321.01, 3777.7, 90.0)}) {
      ClumpedState state;
      state.box = {1e4 + 1e3 * radius, 1e4 + 1e3 * radius, 1.5, 0.0};
      state.positions = {at, at + 2.0 * radius * Vec3(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0)};
      state.masses = {600.0 * radius * radius * radius, 500.0 * radius * radius * radius};
      state.ids = {1, 2};
      const GravityProblem problem = state.problem();
      const std::vector<Vec3> a = by_tree(state, 0.7);
      const Vec3 d = state.positions[1] - state.positions[0]; // the images do 1e-8 of it and less
      const Vec3 newton = problem.newton_g * state.masses[1] / std::pow(d.norm(), 3) * d;
      CHECK((a[0] - newton).norm() < 1e-6 * newton.norm());
    }
}

TEST_CASE("two touching grains far from the middle of their group attract each other as if alone") {
  // Two distant particles make the group's box wide; the grains are 100 m from its centre.
  ClumpedState state;
  state.box = {9000.0, 8000.0, 1.5, 0.0};
  state.positions = {Vec3(-100.0, -100.0, 0.0), Vec3(100.0, 100.0, 0.0), Vec3(90.1, 50.3, 1.7),
                     Vec3(90.1, 50.3 + 0.002, 1.7)}; // radii of 1 mm
  state.masses = {1e-9, 1e-9, 2.5e-6, 2.5e-6};
  state.ids = {1, 2, 3, 4};
  const double d = state.positions[3].y() - state.positions[2].y();
  const double newton = state.problem().newton_g * 2.5e-6 / (d * d);
  const std::vector<Vec3> a = by_tree(state, 0.7);
  CHECK(a[2].y() == doctest::Approx(newton).epsilon(1e-6));
  CHECK(a[3].y() == doctest::Approx(-newton).epsilon(1e-6));
}

TEST_CASE("an angle of any size never opens a cell onto itself") {
  // With a huge angle only the rule on overlapping boxes prevents a group from taking its own cell as a whole.
  const ClumpedState state = clumped_state(300, 8);
  for (const Vec3& a : by_tree(state, 1e9))
    CHECK(a.allFinite());
  CHECK(rms_error(by_tree(state, 1e9), by_direct(state)) < 0.5);
}

TEST_CASE("a particle far from all others feels their exact field") {
  ClumpedState state = clumped_state(1000, 9);
  state.positions[17].z() = 5000.0; // cells of at most 80 m: the octupole term is below (80/5000)³ = 4e-6
  const std::vector<Vec3> exact = by_direct(state), a = by_tree(state, 0.7);
  double scale = 0.0;
  for (const Vec3& v : exact)
    scale += v.norm() / 1000.0;
  // all get the correction that conserves momentum: some 3e-4 of the others' accelerations
  CHECK((a[17] - exact[17]).norm() < 4e-6 * exact[17].norm() + 5e-4 * scale);
}

TEST_CASE("a particle alone feels nothing: its own images cancel") {
  ClumpedState state;
  state.box = {80.0, 60.0, 1.5, 0.0};
  state.positions = {Vec3(31.3, -17.9, 2.2)};
  state.masses = {2513.0};
  state.ids = {4};
  for (const double offset : {0.0, 11.1, 30.0, 59.0}) {
    state.offset = offset;
    const double one_image = state.problem().newton_g * state.masses[0] / (60.0 * 60.0);
    CHECK(by_tree(state, 0.7)[0].norm() < 1e-6 * one_image); // single precision
    CHECK(by_direct(state)[0].norm() < 1e-14 * one_image);
  }
}

TEST_CASE("particles at equal positions end the tree's splitting and give finite accelerations") {
  ClumpedState state = clumped_state(200, 3);
  for (std::size_t k = 0; k < 150; ++k)
    state.positions[k] = state.positions[150] + Vec3(k % 3 == 1 ? 1e-14 : 0.0, k % 3 == 2 ? 1e-120 : 0.0, 0.0);
  for (const double angle : {0.0, 0.7})
    for (const Vec3& a : by_tree(state, angle))
      CHECK(a.allFinite());
  for (const Vec3& a : by_direct(state))
    CHECK(a.allFinite());
}

} // namespace tree_test
