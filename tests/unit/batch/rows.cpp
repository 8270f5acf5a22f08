#include <keeler/batch/rows.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace rows_test {

using namespace keeler;
using namespace keeler::batch;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

RunRow finished(const PlannedRun& run, std::optional<Estimate> value) {
  RunRow row;
  row.run = &run;
  row.status = RunStatus::finished;
  row.numbers.emplace().values = {value};
  return row;
}

} // namespace

TEST_CASE("the mean over seeds has the error of their spread, and one seed its own") {
  const std::vector<Estimate> three = {{1.0, 0.5}, {2.0, unknown}, {6.0, 0.1}};
  CHECK(seed_mean(three).value == doctest::Approx(3.0));
  CHECK(seed_mean(three).error == doctest::Approx(std::sqrt(7.0 / 3.0)));
  CHECK(seed_mean(std::vector<Estimate>{{2.0, 0.25}}).error == 0.25);
  CHECK(std::isnan(seed_mean(std::vector<Estimate>{{2.0, unknown}}).error));
}

TEST_CASE("a point has the finite numbers of its finished runs; a run that cannot be measured has failed") {
  const std::vector<PlannedRun> runs = {{"a", 0, 1, {}}, {"b", 0, 2, {}}, {"c", 0, 3, {}}, {"d", 1, 1, {}}};
  std::vector<RunRow> rows = {finished(runs[0], Estimate{1.0, 0.1}), finished(runs[1], Estimate{3.0, 0.1}),
                              finished(runs[2], Estimate{unknown, 0.1}), RunRow()};
  rows[3].run = &runs[3];
  rows[3].status = RunStatus::failed;
  rows[3].reason = "x";
  rows[3].measurable = false;
  const std::vector<PointRow> points = point_rows(rows, 2, 1);
  REQUIRE(points.size() == 2);
  CHECK(points[0].finished == 3);
  CHECK(points[0].values[0]->value == 2.0);
  CHECK(points[0].scatter[0].count == 2);
  CHECK(points[0].scatter[0].mean == 2.0);
  CHECK(points[1].failed == 1);
  CHECK_FALSE(points[1].values[0].has_value());
  const BatchResult result = result_of(rows);
  CHECK(result.runs == 4);
  CHECK(result.finished == 3);
  CHECK(result.failed == 1);
  CHECK(result.unmeasurable == 1);
  CHECK(row_of(rows[3], {{"setting", "s"}}).dump() ==
        R"({"run":"d","setting":"s","seed":1,"status":"failed","reason":"x"})");
  CHECK(row_of(rows[0], Json::object()).at("reason").is_null());
}

} // namespace rows_test
