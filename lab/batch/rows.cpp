#include <keeler/batch/rows.hpp>

#include <keeler/core/error.hpp>
#include <keeler/runs/run_stage.hpp>

#include <cassert>
#include <cmath>

namespace keeler::batch {
namespace {

std::vector<double> values_of(std::span<const Estimate> seeds) {
  std::vector<double> values;
  for (const Estimate& seed : seeds)
    values.push_back(seed.value);
  return values;
}

RunRow measured_row(const PlannedRun& run, const RunFolders& folders, const MeasureRun& measure) {
  RunRow row;
  row.run = &run;
  if (runs::run_stage(folders.run(run.name)) == runs::RunStage::finished) {
    try {
      row.numbers = measure(run, folders.run(run.name));
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
  const statistics::Scatter scatter = statistics::scatter_of(values_of(seeds));
  return {scatter.mean, scatter.mean_error()};
}

std::vector<RunRow> run_rows(std::span<const PlannedRun> runs, const RunFolders& folders, const MeasureRun& measure) {
  std::vector<RunRow> rows;
  for (const PlannedRun& run : runs)
    rows.push_back(measured_row(run, folders, measure));
  return rows;
}

std::vector<PointRow> point_rows(std::span<const RunRow> runs, std::size_t points, std::size_t columns) {
  std::vector<PointRow> rows(points);
  std::vector<std::vector<std::vector<Estimate>>> seeds(points, std::vector<std::vector<Estimate>>(columns));
  for (const RunRow& run : runs) {
    assert(run.run->point < points && (!run.numbers || run.numbers->values.size() == columns));
    PointRow& row = rows[run.run->point];
    row.finished += run.status == RunStatus::finished ? 1 : 0;
    row.failed += run.status == RunStatus::failed ? 1 : 0;
    row.steady += run.numbers && run.numbers->steady ? 1 : 0;
    for (std::size_t k = 0; run.numbers && k < columns; ++k)
      if (const std::optional<Estimate>& value = run.numbers->values[k]; value && std::isfinite(value->value))
        seeds[run.run->point][k].push_back(*value);
  }
  for (std::size_t p = 0; p < points; ++p) {
    rows[p].point = p;
    for (const std::vector<Estimate>& column : seeds[p]) {
      rows[p].values.push_back(column.empty() ? std::nullopt : std::optional(seed_mean(column)));
      rows[p].scatter.push_back(statistics::scatter_of(values_of(column)));
    }
  }
  return rows;
}

BatchResult result_of(std::span<const RunRow> runs) {
  BatchResult result;
  result.runs = runs.size();
  for (const RunRow& run : runs) {
    result.finished += run.status == RunStatus::finished ? 1 : 0;
    result.failed += run.status == RunStatus::failed ? 1 : 0;
    result.unmeasurable += run.measurable ? 0 : 1;
  }
  return result;
}

Json row_of(const RunRow& run, const Json& settings) {
  Json row = {{"run", run.run->name}};
  row.update(settings);
  row["seed"] = run.run->seed;
  row["status"] = run.status == RunStatus::finished ? "finished" : "failed";
  row["reason"] = run.reason.empty() ? Json(nullptr) : Json(run.reason);
  return row;
}

} // namespace keeler::batch
