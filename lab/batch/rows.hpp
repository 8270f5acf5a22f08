// What came of planned runs: a row per run, and a row per point with the numbers of its seeds together.
#pragma once

#include <keeler/batch/planned_run.hpp>
#include <keeler/batch/quantities.hpp>
#include <keeler/batch/run_folders.hpp>
#include <keeler/statistics/scatter.hpp>

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::batch {

using Json = nlohmann::ordered_json;

enum class RunStatus { finished, failed, unfinished };

/// A planned run, its status and its numbers.
struct RunRow {
  const PlannedRun* run = nullptr;
  RunStatus status = RunStatus::unfinished;
  std::string reason;     ///< reason of the failure
  bool measurable = true; ///< false: it ended normally but has unreadable files, and counts as failed
  std::optional<RunNumbers> numbers;
};

/// The state of a batch after a call.
struct BatchResult {
  bool stopped = false; ///< on request; the tables were not written
  std::size_t runs = 0, finished = 0, failed = 0;
  std::size_t unmeasurable = 0; ///< of `failed`: runs that ended normally but have unreadable files
};

/// A point of the plan: its runs, and by column their numbers. Values that are not finite do not count.
struct PointRow {
  std::size_t point = 0;                            ///< PlannedRun::point
  std::size_t finished = 0, failed = 0, steady = 0; ///< numbers of runs
  std::vector<std::optional<Estimate>> values;      ///< seed_mean(); none: no run has a value
  std::vector<statistics::Scatter> scatter;         ///< of the seeds
};

/// Measures a finished run in its folder. Throws Error if it cannot be measured.
using MeasureRun = std::function<RunNumbers(const PlannedRun&, const std::filesystem::path&)>;

/// Measures the finished runs. The rows refer to `runs`.
std::vector<RunRow> run_rows(std::span<const PlannedRun> runs, const RunFolders& folders, const MeasureRun& measure);

/// Returns a row for each of `points` points. Precondition: the numbers of each run have `columns` values.
std::vector<PointRow> point_rows(std::span<const RunRow> runs, std::size_t points, std::size_t columns);

/// Counts the runs by status.
BatchResult result_of(std::span<const RunRow> runs);

/// Returns the mean over seeds and its standard error, from the scatter of the seeds, or for one seed its error by
/// blocks; NaN if the error is not known. Precondition: `seeds` is not empty.
Estimate seed_mean(std::span<const Estimate> seeds);

/// Returns the first columns of a run's row: run, `settings`, seed, status, reason.
Json row_of(const RunRow& run, const Json& settings);

} // namespace keeler::batch
