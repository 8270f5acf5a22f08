// The guarantees of the solver interface, checked for every solver.
#include <keeler/gravity/solver.hpp>

#include "clumped_state.hpp"
#include "tree.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/gravity/direct.hpp>

#include <doctest/doctest.h>

#include <algorithm>

namespace solver_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

constexpr GravitySettings::Solver all_solvers[] = {GravitySettings::Solver::direct, GravitySettings::Solver::tree,
                                                   GravitySettings::Solver::fft, GravitySettings::Solver::axisymmetric};

constexpr double shortest_wavelength = 3.0; // m: waves in any of the boxes

std::vector<Vec3> solve(GravitySettings::Solver solver, const ClumpedState& state, int rings = 1) {
  const auto gravity =
      make_gravity_solver({.solver = solver, .images = {rings, true}, .shortest_wavelength = shortest_wavelength},
                          state.masses, state.box.area());
  return accelerations(*gravity, state.problem());
}

// Returns a state in another memory order; order[k] is the old index of particle k.
ClumpedState reordered(const ClumpedState& state, const std::vector<std::size_t>& order) {
  ClumpedState other = state;
  for (std::size_t k = 0; k < order.size(); ++k) {
    other.positions[k] = state.positions[order[k]];
    other.masses[k] = state.masses[order[k]];
    other.ids[k] = state.ids[order[k]];
  }
  return other;
}

std::vector<std::size_t> shuffled(std::size_t count) {
  std::vector<std::size_t> order(count);
  for (std::size_t k = 0; k < count; ++k)
    order[k] = (k * 7919 + 13) % count; // 7919 is prime
  return order;
}

} // namespace

TEST_CASE("solvers have the names of the settings") {
  using enum GravitySettings::Solver;
  const std::vector<double> masses(1000, 1.0);
  for (const auto& [solver, name] :
       {std::pair{direct, "direct"}, {tree, "tree"}, {fft, "fft"}, {mesh, "mesh"}, {axisymmetric, "axisymmetric"}})
    CHECK(make_gravity_solver({.solver = solver}, masses, 1e4)->name() == name);
  CHECK(make_gravity_solver({}, masses, 1e4)->name() == "tree");
  CHECK(make_gravity_solver({.solver = automatic}, std::span(masses).first(10), 1e4)->name() == "direct");
}

TEST_CASE("none, one and two particles are problems like any other") {
  for (const auto solver : all_solvers)
    for (const std::size_t count : {0u, 1u, 2u}) {
      const std::vector<Vec3> a = solve(solver, clumped_state(count, 1));
      REQUIRE(a.size() == count);
      for (const Vec3& v : a)
        CHECK(v.allFinite());
    }
}

TEST_CASE("memory order and a solver's past change no bit") {
  const ClumpedState state = clumped_state(2003, 11, 10.0);
  const std::vector<std::size_t> order = shuffled(2003);
  const ClumpedState other = reordered(state, order);
  for (const auto solver : all_solvers) {
    const auto gravity = make_gravity_solver({.solver = solver, .shortest_wavelength = shortest_wavelength},
                                             state.masses, state.box.area());
    const std::vector<Vec3> fresh = accelerations(*gravity, state.problem());
    accelerations(*gravity, clumped_state(2003, 12).problem());
    accelerations(*gravity, clumped_state(50, 12).problem());
    const std::vector<Vec3> later = accelerations(*gravity, other.problem());
    for (std::size_t k = 0; k < order.size(); ++k)
      CHECK(later[k] == fresh[order[k]]);
  }
}

TEST_CASE("the number of threads changes no bit") {
  const ClumpedState state = clumped_state(3000, 13);
  const int before = threads();
  for (const auto solver : all_solvers) {
    set_threads(1);
    const std::vector<Vec3> one = solve(solver, state);
    for (const int count : {2, 3}) {
      set_threads(count);
      CHECK(solve(solver, state) == one);
    }
  }
  set_threads(before);
}

TEST_CASE("the instruction set changes no bit") {
  const ClumpedState state = clumped_state(1500, 14, 10.0);
  const GravityProblem problem = state.problem();
  DirectSolver direct({}, InstructionSet::portable);
  TreeSolver tree(0.6, {}, InstructionSet::portable);
  const std::vector<Vec3> direct_bits = accelerations(direct, problem), tree_bits = accelerations(tree, problem);
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!supports(set))
      continue;
    DirectSolver wide_direct({}, set);
    TreeSolver wide_tree(0.6, {}, set);
    CHECK(accelerations(wide_direct, problem) == direct_bits);
    CHECK(accelerations(wide_tree, problem) == tree_bits);
  }
}

TEST_CASE("offsets a whole box length apart are the same problem") {
  ClumpedState state = clumped_state(500, 15);
  state.box = {64.0, 64.0, 1.5, 0.0};
  for (Vec3& p : state.positions)
    p.head<2>() *= 0.9;
  for (const auto solver : all_solvers) {
    state.offset = 11.25; // few bits: every sum of it with box lengths is exact
    const std::vector<Vec3> a = solve(solver, state);
    for (const double other : {75.25, -52.75, 1035.25}) {
      state.offset = other;
      CHECK(solve(solver, state) == a);
    }
  }
}

TEST_CASE("accelerations do not depend on which image of a particle is given") {
  const ClumpedState state = clumped_state(500, 16);
  ClumpedState moved = state;
  for (std::size_t k = 0; k < moved.positions.size(); ++k)
    moved.positions[k] +=
        state.box.displacement({static_cast<int>(k % 5) - 2, static_cast<int>(k % 3) - 1}, state.offset);
  for (const auto solver : all_solvers) // the round trip rounds coordinates up to 150 m
    CHECK(rms_error(solve(solver, moved), solve(solver, state)) < 1e-12);
}

TEST_CASE("crossing the edge of the cell changes forces by no more than the fit of the far images") {
  const ClumpedState state = clumped_state(1500, 17);
  const std::size_t crosser = 40;
  const double sheet = state.problem().newton_g * 600.0 * 4.0 / 3.0 * pi * 1500 / state.box.area(); // G Σ
  for (const auto solver : all_solvers) {
    ClumpedState inside = state, outside = state;
    inside.positions[crosser] = Vec3(0.5 * state.box.size_x - 1e-9, 3.0, 9.0);
    outside.positions[crosser] = Vec3(0.5 * state.box.size_x + 1e-9, 3.0, 9.0);
    const std::vector<Vec3> before = solve(solver, inside), after = solve(solver, outside);
    double others = 0.0;
    for (std::size_t k = 0; k < before.size(); ++k)
      if (k != crosser)
        others = std::max(others, (after[k] - before[k]).norm());
    MESSAGE("jump / G Sigma: " << (after[crosser] - before[crosser]).norm() / sheet);
    // the tree's groups change when a particle changes sides
    const double bound = solver == GravitySettings::Solver::direct ? 1e-3 : 0.05;
    CHECK((after[crosser] - before[crosser]).norm() < bound * sheet);
    CHECK(others < bound * sheet);
  }
}

} // namespace solver_test
