#include <keeler/gravity/tree.hpp>

#include <keeler/gravity/direct.hpp>

#include "clumped_state.hpp"

#include <doctest/doctest.h>

using namespace keeler;
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

TEST_CASE("the tree nearly keeps the momentum") {
  const ClumpedState state = clumped_state(4000, 1);
  for (const double angle : {0.7, 0.5}) {
    const std::vector<Vec3> a = by_tree(state, angle);
    Vec3 sum = Vec3::Zero();
    double whole = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      sum += state.masses[k] * a[k];
      whole += state.masses[k] * a[k].norm();
    }
    MESSAGE("angle " << angle << ", sum of m a / sum of |m a|: " << sum.norm() / whole);
    CHECK(sum.norm() < (angle > 0.6 ? 1e-3 : 3e-4) * whole); // well below the rms error: errors cancel
  }
}

TEST_CASE("with more rings and at other offsets the tree still follows the direct sum") {
  ClumpedState state = clumped_state(1000, 4);
  for (const double part : {0.0, 0.5, 0.9})
    for (const int rings : {0, 2}) {
      state.offset = part * state.box.size_y;
      CHECK(rms_error(by_tree(state, 0.5, rings), by_direct(state, rings)) < 1e-3);
    }
}

TEST_CASE("a closed opening angle gives the direct sum to rounding in single precision") {
  const ClumpedState state = clumped_state(1500, 6, 10.0);
  const std::vector<Vec3> exact = by_direct(state);
  CHECK(rms_error(by_tree(state, 0.0), exact) < 1e-7);
  CHECK(rms_error(by_tree(state, 1e-9), exact) < 1e-7);
}

TEST_CASE("an angle of any size never opens a cell onto itself") {
  // With a huge angle only the rule on overlapping boxes forbids taking the own cell as a whole.
  const ClumpedState state = clumped_state(300, 8);
  for (const Vec3& a : by_tree(state, 1e9))
    CHECK(a.allFinite());
  CHECK(rms_error(by_tree(state, 1e9), by_direct(state)) < 0.5);
}

TEST_CASE("a particle far from all others feels them as they are") {
  ClumpedState state = clumped_state(1000, 9);
  state.positions[17].z() = 5000.0; // cells of at most 80 m: the octupole term is below (80/5000)³ = 4e-6
  const std::vector<Vec3> exact = by_direct(state);
  CHECK((by_tree(state, 0.7)[17] - exact[17]).norm() < 4e-6 * exact[17].norm());
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

TEST_CASE("particles at one place neither hang the tree nor give anything but numbers") {
  ClumpedState state = clumped_state(200, 3);
  for (std::size_t k = 0; k < 150; ++k)
    state.positions[k] = state.positions[150] + Vec3(k % 3 == 1 ? 1e-14 : 0.0, k % 3 == 2 ? 1e-120 : 0.0, 0.0);
  for (const double angle : {0.0, 0.7})
    for (const Vec3& a : by_tree(state, angle))
      CHECK(a.allFinite());
  for (const Vec3& a : by_direct(state))
    CHECK(a.allFinite());
}
