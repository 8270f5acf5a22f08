// The tables of a sweep: a row a run, and a row a point of the grid with means over the seeds.
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

/// A run of the plan and what is known of it.
struct RunRow {
  const PlannedRun* run = nullptr;
  RunStatus status = RunStatus::unfinished;
  std::string reason;     ///< why it failed
  bool measurable = true; ///< false: it failed after its end, for its files cannot be read
  std::optional<RunNumbers> numbers;
};

std::size_t count_of(const std::vector<RunRow>& runs, RunStatus status);

/// A point of the grid: means over its finished runs.
struct PointRow {
  const GridPoint* point = nullptr;
  std::size_t finished = 0, failed = 0, steady = 0; ///< runs
  std::vector<std::optional<Estimate>> values;      ///< in the order of the columns; none: no run has it
};

/// Mean over seeds, and its standard error: from the spread of the seeds; of one seed its own error by blocks. Errors
/// that are not known are NaN. At least one value.
Estimate seed_mean(std::span<const Estimate> seeds);

/// Measures the finished runs. They belong to the plan.
std::vector<RunRow> run_rows(const Grid& grid, const Plan& plan, const RunFolders& folders);

/// They belong to the plan.
std::vector<PointRow> point_rows(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs);

/// As objects, a column a name; what is not known is null. Of runs the finished and the failed ones, of points those
/// with a finished run.
Json runs_as_json(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs);
Json points_as_json(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points);

} // namespace keeler
