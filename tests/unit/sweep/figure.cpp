#include "figure.hpp"
#include "grids.hpp"

#include <doctest/doctest.h>

namespace figure_test {

using namespace keeler;
using namespace keeler::sweep;
using namespace keeler::test;

namespace {

// The chosen y is 10 times the position of the point in the plan.
std::vector<batch::PointRow> made_up_points(const Plan& plan) {
  std::vector<batch::PointRow> points(plan.points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    points[p].point = p;
    points[p].values.assign(batch::RunQuantities().columns().size(), Estimate{10.0 * static_cast<double>(p), 0.5});
  }
  return points;
}

} // namespace

TEST_CASE("a plot has a line for each value of the other axes, in the order of x") {
  const GridFile file("scene = \"scene.toml\"\n[[axis]]\nkey = \"particles.optical_depth\"\nvalues = [0.4, 0.2]\n"
                      "[[axis]]\nkey = \"time.step\"\nvalues = [1e-3, 2e-3]\n");
  const Grid grid = file.grid();
  const Plan plan = plan_runs(grid);
  std::vector<batch::PointRow> points = made_up_points(plan);
  std::vector<plot::PlotCurve> lines = sweep_curves(grid, plan, points);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].name == "time.step = 0.001");
  REQUIRE(lines[0].points.size() == 2);
  CHECK(lines[0].points[0].x == 0.2);
  CHECK(lines[0].points[0].y == 20.0);
  CHECK(lines[0].points[1].x == 0.4);
  CHECK(lines[0].points[1].y == 0.0);
  CHECK(lines[1].points[1].y == 10.0);
  CHECK(lines[1].points[1].error == 0.5);
  for (batch::PointRow& row : points)
    row.values.assign(batch::RunQuantities().columns().size(), std::nullopt);
  CHECK(sweep_curves(grid, plan, points).empty());
}

TEST_CASE("words along x stand at their places") {
  const GridFile file("scene = \"scene.toml\"\n[[axis]]\nkey = \"collisions.finder\"\n"
                      "values = [\"certified\", \"linear-full\"]\n");
  const Grid grid = file.grid();
  const Plan plan = plan_runs(grid);
  const std::vector<plot::PlotCurve> lines = sweep_curves(grid, plan, made_up_points(plan));
  REQUIRE(lines.size() == 1);
  CHECK(lines[0].name.empty());
  CHECK(lines[0].points[0].x == 0.0);
  CHECK(lines[0].points[1].x == 1.0);
}

} // namespace figure_test
