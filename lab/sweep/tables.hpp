// The tables of a sweep: one row per run, and one row per point of the grid with means over the seeds.
#pragma once

#include "plan.hpp"

#include <keeler/batch/quantities.hpp>
#include <keeler/batch/run_folders.hpp>

#include <nlohmann/json.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler {

using Json = nlohmann::ordered_json;

enum class RunStatus { finished, failed, unfinished };

/// A run of the plan, its status and its numbers.
struct RunRow {
  const PlannedRun* run = nullptr;
  RunStatus status = RunStatus::unfinished;
  std::string reason;     ///< reason of the failure
  bool measurable = true; ///< false: it ended normally but has unreadable files, and counts as failed
  std::optional<RunNumbers> numbers;
};

/// Returns the number of runs with a status.
std::size_t count_of(const std::vector<RunRow>& runs, RunStatus status);

/// A point of the grid: means over its finished runs.
struct PointRow {
  const GridPoint* point = nullptr;
  std::size_t finished = 0, failed = 0, steady = 0; ///< numbers of runs
  std::vector<std::optional<Estimate>> values;      ///< in the order of the columns; none: no run has a value
};

/// Returns the mean over seeds and its standard error, from the scatter of the seeds, or for one seed its error by
/// blocks; NaN if the error is not known. Precondition: `seeds` is not empty.
Estimate seed_mean(std::span<const Estimate> seeds);

/// Measures the finished runs. The rows refer to the plan.
std::vector<RunRow> run_rows(const Grid& grid, const Plan& plan, const RunFolders& folders);

/// Averages over the runs of each point. The rows refer to the plan.
std::vector<PointRow> point_rows(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs);

/// Returns a list of objects with one member per column, null for unknown values: of the finished and failed runs, and
/// of the points with a finished run.
Json runs_as_json(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs);
Json points_as_json(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points);

} // namespace keeler
