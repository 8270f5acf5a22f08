#include <keeler/gravity/direct.hpp>

#include <keeler/core/threads.hpp>

#include "clumped_state.hpp"

#include <doctest/doctest.h>

namespace direct_test {

using namespace keeler;
using namespace keeler::gravity;
using namespace keeler_test;

namespace {

using Long3 = Eigen::Matrix<long double, 3, 1>;

// Returns the sum over all pairs and images by definition: columns n_x = −rings … rings, and in each of them the boxes
// within (rings + ½) L_y. Precondition: positions are inside the cell.
std::vector<Vec3> naive(const GravityProblem& problem, int rings) {
  const ShearingBox& box = problem.box;
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < problem.positions.size(); ++i) {
    Long3 sum = Long3::Zero();
    for (std::size_t j = 0; j < problem.positions.size(); ++j)
      for (int nx = -rings; nx <= rings; ++nx)
        for (int ny = -30; ny <= 30; ++ny) {
          const Long3 shift(nx * static_cast<long double>(box.size_x),
                            ny * static_cast<long double>(box.size_y) - nx * static_cast<long double>(problem.offset),
                            0.0L);
          if (std::fabs(shift.y()) > (rings + 0.5L) * box.size_y || (i == j && nx == 0 && ny == 0))
            continue;
          const Long3 d = problem.positions[j].cast<long double>() + shift - problem.positions[i].cast<long double>();
          const long double distance = d.norm();
          sum += problem.masses[j] / (distance * distance * distance) * d;
        }
    result.push_back((static_cast<long double>(problem.newton_g) * sum).cast<double>());
  }
  return result;
}

DirectSolver direct(int rings, bool far = false) {
  return DirectSolver({rings, far}, choose_instruction_set());
}

} // namespace

TEST_CASE("two bodies attract each other by Newton's law") {
  ClumpedState state;
  state.box = {100.0, 100.0, 1.5, 0.0};
  state.positions = {Vec3(1.0, 2.0, 3.0), Vec3(2.0, 0.0, 5.0)}; // 3 m apart
  state.masses = {2500.0, 7000.0};
  state.ids = {1, 2};
  GravityProblem problem = state.problem();
  DirectSolver solver = direct(0);
  const std::vector<Vec3> a = accelerations(solver, problem);
  const Vec3 unit(1.0 / 3.0, -2.0 / 3.0, 2.0 / 3.0);
  CHECK((a[0] - problem.newton_g * 7000.0 / 9.0 * unit).norm() < 1e-15 * a[0].norm());
  CHECK((a[1] + problem.newton_g * 2500.0 / 9.0 * unit).norm() < 1e-15 * a[1].norm());
}

TEST_CASE("the direct sum equals the triple loop in extended precision") {
  ClumpedState state = clumped_state(150, 2, 10.0);
  for (const double part : {0.0, 0.2, 0.5, 0.77})
    for (const int rings : {0, 1, 2}) {
      state.offset = part * state.box.size_y;
      if (part == 0.5)
        state.offset += 1e-9; // at one half two numberings of a column are equally near
      for (Vec3& p : state.positions)
        p = into_cell(state.box, folded_offset(state.box, state.offset), p);
      DirectSolver solver = direct(rings);
      // 1e-14: coordinates of 15 m hold contacts of 2 m to about 1e-15, and sums of 4000 terms add a little
      CHECK(rms_error(accelerations(solver, state.problem()), naive(state.problem(), rings)) < 1e-14);
    }
}

TEST_CASE("in single precision the direct sum is accurate to a few 1e-7, for equal spheres and for 1:1000") {
  for (const double size_range : {1.0, 1000.0}) {
    const ClumpedState state = clumped_state(1500, 7, size_range);
    DirectSolver exact = direct(1, true), fast({}, choose_instruction_set(), Precision::single_precision);
    const double error = rms_error(accelerations(fast, state.problem()), accelerations(exact, state.problem()));
    MESSAGE("radii 1:" << size_range << ", rms error of single precision: " << error);
    CHECK(error < 1e-6);
  }
}

TEST_CASE("single precision gives equal bits for all threads and instruction sets") {
  const ClumpedState state = clumped_state(700, 8, 10.0);
  const int before = threads();
  set_threads(1);
  DirectSolver portable({}, InstructionSet::portable, Precision::single_precision);
  const std::vector<Vec3> expected = accelerations(portable, state.problem());
  for (const InstructionSet set : {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512}) {
    if (!supports(set))
      continue;
    set_threads(2);
    DirectSolver solver({}, set, Precision::single_precision);
    CHECK(accelerations(solver, state.problem()) == expected);
  }
  set_threads(before);
}

TEST_CASE("a contact across the sheared edge counts at its true distance") {
  ClumpedState state;
  state.box = {64.0, 48.0, 1.5, 0.0};
  state.offset = 20.0;
  state.masses = {1000.0, 1000.0};
  state.ids = {1, 2};
  state.positions = {Vec3(31.0, 3.0, 0.0), Vec3(-31.0, 3.0 + 20.0, 0.0)}; // its image is at (33, 3, 0)
  const GravityProblem problem = state.problem();
  DirectSolver solver = direct(1);
  const Vec3 a = accelerations(solver, problem)[0];
  const double newton = problem.newton_g * 1000.0 / 4.0;
  CHECK((a - naive(problem, 1)[0]).norm() < 1e-14 * newton);
  CHECK((a - Vec3(newton, 0.0, 0.0)).norm() < 1e-2 * newton); // other images: at 40 m and more, (2/40)² each
}

TEST_CASE("the direct sum conserves momentum") {
  for (const double part : {0.0, 0.37, 0.5, 0.9}) {
    ClumpedState state = clumped_state(700, 3, 5.0);
    state.offset = part * state.box.size_y;
    DirectSolver solver = direct(1, true);
    const std::vector<Vec3> a = accelerations(solver, state.problem());
    Vec3 sum = Vec3::Zero();
    double whole = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      sum += state.masses[k] * a[k];
      whole += state.masses[k] * a[k].norm();
    }
    CHECK(sum.norm() < 1e-12 * whole);
  }
}

TEST_CASE("the direct sum with all images is the sum of the lattice's field over all pairs") {
  for (const double part : {0.0, 0.37, 0.5}) {
    ClumpedState state = clumped_state(150, 18, 3.0);
    state.offset = part * state.box.size_y;
    for (Vec3& p : state.positions)
      p = into_cell(state.box, folded_offset(state.box, state.offset), p);
    const std::vector<Vec3> exact = exact_pair_by_pair(state);
    double last = 1e-3; // two spheres in contact attract a hundred times more than the sheet
    for (const int rings : {1, 2, 3}) {
      DirectSolver solver = direct(rings, true);
      const double error = rms_error(accelerations(solver, state.problem()), exact);
      MESSAGE("offset " << part << " L_y, " << rings << " rings: rms error " << error);
      CHECK(error < last);
      last = error / 10.0;
    }
  }
}

TEST_CASE("the direct sum is exact in a box that is higher than wide") {
  for (const double height : {15.0, 40.0, 60.0}) {
    ClumpedState state;
    state.box = {20.0, 24.0, 1.5, 0.0};
    state.offset = 7.0;
    for (std::uint64_t k = 0; k < 60; ++k) {
      RandomStream random(4, RandomPurpose::position, k);
      const double x = (random.uniform() - 0.5) * 20.0, y = (random.uniform() - 0.5) * 24.0;
      state.positions.emplace_back(x, y, (random.uniform() - 0.5) * 2.0 * height);
      state.masses.push_back(1000.0);
      state.ids.push_back(k);
    }
    const std::vector<Vec3> exact = exact_pair_by_pair(state);
    DirectSolver solver = direct(1, true);
    const double error = rms_error(accelerations(solver, state.problem()), exact);
    MESSAGE("height " << height << ": rms error " << error);
    CHECK(error < 1e-3);
  }
}

TEST_CASE("plain rings of images leave an error in the plane that falls slowly with their number") {
  const ClumpedState state = clumped_state(800, 18);
  const auto in_plane = [&](int rings, bool far) {
    DirectSolver solver = direct(rings, far);
    std::vector<Vec3> a = accelerations(solver, state.problem());
    for (Vec3& v : a)
      v.z() = 0.0;
    return a;
  };
  const std::vector<Vec3> exact = in_plane(2, true);
  double last = 1.0;
  for (const int rings : {1, 2, 4}) {
    const double error = rms_error(in_plane(rings, false), exact);
    MESSAGE(rings << " plain rings: rms error in the plane " << error);
    CHECK(error > 0.05);
    CHECK(error < 0.8 * last);
    last = error;
  }
  CHECK(rms_error(in_plane(1, true), exact) < 1e-4);
}

} // namespace direct_test
