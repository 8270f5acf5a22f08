#include <keeler/gravity/direct.hpp>

#include "clumped_state.hpp"

#include <doctest/doctest.h>

using namespace keeler;
using namespace keeler_test;

namespace {

using Long3 = Eigen::Matrix<long double, 3, 1>;

// The sum over all pairs and images, as it is defined: columns n_x = −rings … rings, and in each of them the boxes
// that reach no farther than (rings + ½) L_y. Positions must be inside the cell.
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

DirectSolver direct(int rings) {
  return DirectSolver(rings, choose_instruction_set());
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
        state.offset += 1e-9; // at one half both numberings of a column are equally near
      for (Vec3& p : state.positions)
        p = into_cell(state.box, folded_offset(state.box, state.offset), p);
      DirectSolver solver = direct(rings);
      // 1e-14: places of 15 m hold contacts of 2 m to about 1e-15, and sums of 4000 terms add a little
      CHECK(rms_error(accelerations(solver, state.problem()), naive(state.problem(), rings)) < 1e-14);
    }
}

TEST_CASE("a contact across the sheared edge counts at its true distance") {
  ClumpedState state;
  state.box = {64.0, 48.0, 1.5, 0.0};
  state.offset = 20.0;
  state.masses = {1000.0, 1000.0};
  state.ids = {1, 2};
  state.positions = {Vec3(31.0, 3.0, 0.0), Vec3(-31.0, 3.0 + 20.0, 0.0)}; // its image stands at (33, 3, 0)
  const GravityProblem problem = state.problem();
  DirectSolver solver = direct(1);
  const Vec3 a = accelerations(solver, problem)[0];
  const double newton = problem.newton_g * 1000.0 / 4.0;
  CHECK((a - naive(problem, 1)[0]).norm() < 1e-14 * newton);
  CHECK((a - Vec3(newton, 0.0, 0.0)).norm() < 1e-2 * newton); // other images: at 40 m and more, (2/40)² each
}

TEST_CASE("the direct sum keeps the momentum") {
  for (const double part : {0.0, 0.37, 0.5, 0.9}) {
    ClumpedState state = clumped_state(700, 3, 5.0);
    state.offset = part * state.box.size_y;
    DirectSolver solver = direct(1);
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

TEST_CASE("what plain rings lack of a periodic sheet falls with every ring") {
  const ClumpedState state = clumped_state(800, 18);
  const double sheet =
      state.problem().newton_g * 800 * state.masses[0] / state.box.area(); // G times the surface density
  DirectSolver many = direct(16);
  const std::vector<Vec3> reference = accelerations(many, state.problem());
  double last = 1e300;
  for (const int rings : {0, 1, 2, 4, 8}) {
    DirectSolver few = direct(rings);
    const std::vector<Vec3> a = accelerations(few, state.problem());
    double plane = 0.0, plane_whole = 0.0, vertical = 0.0, vertical_whole = 0.0, pull = 0.0;
    int at_edge = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Vec3 lack = a[k] - reference[k];
      plane += lack.head<2>().squaredNorm();
      plane_whole += reference[k].head<2>().squaredNorm();
      vertical += lack.z() * lack.z();
      vertical_whole += reference[k].z() * reference[k].z();
      if (std::fabs(state.positions[k].x()) > 0.45 * state.box.size_x) {
        pull -= state.positions[k].x() > 0.0 ? lack.x() : -lack.x();
        ++at_edge;
      }
    }
    pull /= at_edge * sheet;
    MESSAGE(rings << " rings: rms error in the plane " << std::sqrt(plane / plane_whole) << ", vertical "
                  << std::sqrt(vertical / vertical_whole) << ", inward pull in the outer tenth " << pull << " G Sigma");
    CHECK(pull > 0.0);
    CHECK(pull < 0.6 * last); // measured in a sheet: 0.54 from 1 ring to 2, less elsewhere
    last = pull;
  }
}
