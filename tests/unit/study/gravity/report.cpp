#include "gravity/report.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace report_test {

using namespace keeler;

namespace {

Json row(double ns, double error, double value = 0.0) {
  return {{"solver", "tree"}, {"ns_per_particle", ns}, {"error_rms", error}, {"value", value}};
}

} // namespace

TEST_CASE("the front has what no other setting beats in both") {
  const Json rows = {row(300, 1e-3), row(100, 1e-2), row(200, 2e-2), row(400, 1e-3), row(500, 1e-4), row(100, 3e-2)};
  const std::vector<Json> front = pareto_front(rows);
  REQUIRE(front.size() == 3);
  CHECK(front[0] == row(100, 1e-2));
  CHECK(front[1] == row(300, 1e-3));
  CHECK(front[2] == row(500, 1e-4));
}

TEST_CASE("the order of convergence is the power of the parameter") {
  std::vector<Json> rows;
  for (const double value : {0.2, 0.3, 0.5, 0.9})
    rows.push_back(row(1.0, 0.02 * std::pow(value, 3.7), value));
  CHECK(convergence_order(rows) == doctest::Approx(3.7).epsilon(1e-12));
}

} // namespace report_test
