#include "tables.hpp"

#include "grids.hpp"

#include <keeler/report/csv.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <map>

namespace tables_test {

using namespace keeler;
using namespace keeler::sweep;
using namespace keeler::test;

namespace {

const char* const text = R"(
scene = "scene.toml"
seeds = [1, 2, 3]
[[axis]]
key = "particles.optical_depth"
values = [0.1, 0.2]
[[axis]]
key = "time.step"
values = [1e-3, 2e-3]
)";

// Makes a number for each run and quantity; some runs have failed, some quantities are unknown.
std::vector<batch::RunRow> made_up_rows(const Plan& plan) {
  std::vector<batch::RunRow> rows;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    batch::RunRow row;
    row.run = &plan.runs[k];
    if (k == 4) {
      row.status = batch::RunStatus::failed;
      row.reason = "no room, \"none\"";
    } else if (k != 7) {
      row.status = batch::RunStatus::finished;
      row.numbers.emplace();
      row.numbers->steady = k % 2 == 0;
      for (std::size_t q = 0; q < batch::RunQuantities().columns().size(); ++q) {
        const double value = std::sin(1.7 * static_cast<double>(k) + 0.3 * static_cast<double>(q * q));
        row.numbers->values.push_back(q % 5 == 3 && k % 3 == 1 ? std::nullopt
                                                               : std::optional(Estimate{value, 0.1 * value}));
      }
    }
    rows.push_back(row);
  }
  return rows;
}

// The brute-force mean and error, by sums over all pairs: Σ (a − b)² over pairs is n times the sum of squares about the
// mean.
Estimate plain_mean(const std::vector<Estimate>& seeds) {
  const double n = static_cast<double>(seeds.size());
  if (seeds.size() == 1)
    return seeds.front();
  double sum = 0.0, pairs = 0.0;
  for (std::size_t a = 0; a < seeds.size(); ++a) {
    sum += seeds[a].value;
    for (std::size_t b = 0; b < a; ++b)
      pairs += (seeds[a].value - seeds[b].value) * (seeds[a].value - seeds[b].value);
  }
  return {sum / n, std::sqrt(pairs / n / (n - 1.0) / n)};
}

} // namespace

TEST_CASE("a point has the mean of its finished runs, as sums over all pairs of runs give it") {
  const GridFile file(text);
  const Grid grid = file.grid();
  const Plan plan = plan_runs(grid);
  const std::vector<batch::RunRow> runs = made_up_rows(plan);
  const std::vector<batch::PointRow> points =
      point_rows(runs, plan.points.size(), batch::RunQuantities().columns().size());
  REQUIRE(points.size() == 4);
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::size_t q = 0; q < batch::RunQuantities().columns().size(); ++q) {
      std::vector<Estimate> seeds;
      for (const batch::RunRow& run : runs)
        if (run.run->point == p && run.numbers && run.numbers->values[q])
          seeds.push_back(*run.numbers->values[q]);
      REQUIRE(points[p].values[q].has_value() == !seeds.empty());
      const Estimate plain = plain_mean(seeds);
      CHECK(points[p].values[q]->value == doctest::Approx(plain.value).epsilon(1e-12));
      CHECK(points[p].values[q]->error == doctest::Approx(plain.error).epsilon(1e-9));
    }
  CHECK(points[0].finished == 3);
  CHECK(points[0].steady == 2);
  CHECK(points[1].failed == 1);
  CHECK(points[2].finished == 2);
}

TEST_CASE("tables have finished and failed runs, with gaps where nothing is known") {
  const GridFile file(text);
  const Grid grid = file.grid();
  const Plan plan = plan_runs(grid);
  const std::vector<batch::RunRow> runs = made_up_rows(plan);
  const std::string csv = report::csv_with_gaps(runs_as_json(grid, plan, runs));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 12); // the header and all runs but the one that is not finished
  CHECK(csv.starts_with("run,particles.optical_depth,time.step,seed,status,reason,particle_count,since_orbit,"));
  CHECK(csv.find("\noptical_depth-0.1_step-0.002_seed-2,0.1,0.002,2,failed,\"no room, \"\"none\"\"\",,") != csv.npos);
  CHECK(csv.find("null") == csv.npos);
  const batch::Json points =
      points_as_json(grid, plan, point_rows(runs, plan.points.size(), batch::RunQuantities().columns().size()));
  CHECK(points[3].at("particles.optical_depth") == 0.2);
  CHECK(points[1].at("failed_runs") == 1);
}

} // namespace tables_test
