#include "tables.hpp"

#include <keeler/core/error.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/runs/run_stage.hpp>
#include <keeler/statistics/scatter.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {
namespace {

void add_settings(Json& row, const Plan& plan, const GridPoint& point) {
  assert(point.settings.size() == plan.keys.size());
  for (std::size_t k = 0; k < plan.keys.size(); ++k) {
    const GridValue& value = *point.settings[k];
    const Json number = Json::parse(value.label, nullptr, false);
    row[plan.keys[k]] = value.number && number.is_number() ? number : Json(value.label);
  }
}

void add_values(Json& row, const RunQuantities& quantities, const std::vector<std::optional<Estimate>>& values) {
  for (std::size_t k = 0; k < quantities.columns().size(); ++k) {
    const std::optional<Estimate> value = k < values.size() ? values[k] : std::nullopt;
    row[quantities.columns()[k].name] = value ? or_null(value->value) : Json(nullptr);
    row[quantities.columns()[k].error_name] = value ? or_null(value->error) : Json(nullptr);
  }
}

RunRow measured_row(const Grid& grid, const PlannedRun& run, const RunFolders& folders) {
  RunRow row;
  row.run = &run;
  if (run_stage(folders.run(run.name)) == RunStage::finished) {
    try {
      row.numbers = grid.quantities.measure(folders.run(run.name), run.scene, grid.since);
      row.status = RunStatus::finished;
    } catch (const Error& error) { // a damaged run must not prevent the table of the others
      row.status = RunStatus::failed;
      row.reason = error.what();
      row.measurable = false;
    }
  } else if (const std::optional<std::string> reason = folders.failure_of(run.name)) {
    row.status = RunStatus::failed;
    row.reason = *reason;
  }
  return row;
}

} // namespace

Estimate seed_mean(std::span<const Estimate> seeds) {
  assert(!seeds.empty());
  if (seeds.size() == 1)
    return seeds.front();
  std::vector<double> values;
  for (const Estimate& seed : seeds)
    values.push_back(seed.value);
  const Scatter scatter = scatter_of(values);
  return {scatter.mean, scatter.mean_error()};
}

std::size_t count_of(const std::vector<RunRow>& runs, RunStatus status) {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [&](const RunRow& run) { return run.status == status; }));
}

std::vector<RunRow> run_rows(const Grid& grid, const Plan& plan, const RunFolders& folders) {
  std::vector<RunRow> rows;
  for (const PlannedRun& run : plan.runs)
    rows.push_back(measured_row(grid, run, folders));
  return rows;
}

std::vector<PointRow> point_rows(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs) {
  const std::size_t columns = grid.quantities.columns().size();
  std::vector<PointRow> rows(plan.points.size());
  for (std::size_t p = 0; p < rows.size(); ++p)
    rows[p].point = &plan.points[p];
  std::vector<std::vector<std::vector<Estimate>>> seeds(rows.size(), std::vector<std::vector<Estimate>>(columns));
  for (const RunRow& run : runs) {
    assert(run.run->point < rows.size());
    PointRow& row = rows[run.run->point];
    row.finished += run.status == RunStatus::finished ? 1 : 0;
    row.failed += run.status == RunStatus::failed ? 1 : 0;
    if (!run.numbers)
      continue;
    row.steady += run.numbers->steady ? 1 : 0;
    for (std::size_t k = 0; k < columns; ++k)
      if (const std::optional<Estimate>& value = run.numbers->values[k]; value && std::isfinite(value->value))
        seeds[run.run->point][k].push_back(*value);
  }
  for (std::size_t p = 0; p < rows.size(); ++p)
    for (const std::vector<Estimate>& of_seeds : seeds[p])
      rows[p].values.push_back(of_seeds.empty() ? std::nullopt : std::optional(seed_mean(of_seeds)));
  return rows;
}

Json runs_as_json(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs) {
  Json rows = Json::array();
  for (const RunRow& run : runs) {
    if (run.status == RunStatus::unfinished)
      continue;
    const RunNumbers numbers = run.numbers.value_or(RunNumbers());
    Json row;
    row["run"] = run.run->name;
    add_settings(row, plan, plan.points[run.run->point]);
    row["seed"] = run.run->seed;
    row["status"] = run.status == RunStatus::finished ? "finished" : "failed";
    row["reason"] = run.reason.empty() ? Json(nullptr) : Json(run.reason);
    row["particle_count"] = run.numbers ? Json(numbers.particle_count) : Json(nullptr);
    row["since_orbit"] = or_null(numbers.since_orbit);
    row["until_orbit"] = or_null(numbers.until_orbit);
    row["steady"] = run.numbers ? Json(numbers.steady) : Json(nullptr);
    add_values(row, grid.quantities, numbers.values);
    rows.push_back(row);
  }
  return rows;
}

Json points_as_json(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points) {
  Json rows = Json::array();
  for (const PointRow& point : points) {
    if (point.finished == 0)
      continue;
    Json row;
    add_settings(row, plan, *point.point);
    row["finished_runs"] = point.finished;
    row["failed_runs"] = point.failed;
    row["steady_runs"] = point.steady;
    add_values(row, grid.quantities, point.values);
    rows.push_back(row);
  }
  return rows;
}

} // namespace keeler
