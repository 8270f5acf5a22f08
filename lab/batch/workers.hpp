// Execution of a list of runs, several at once, each in a separate process. Any number of programs may work in one
// folder: each takes the next run that is neither finished nor claimed.
#pragma once

#include <keeler/batch/claims.hpp>
#include <keeler/batch/planned_run.hpp>
#include <keeler/batch/run_folders.hpp>
#include <keeler/core/progress.hpp>
#include <keeler/runs/run.hpp>

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace keeler::batch {

/// The settings of every batch.
struct BatchSettings {
  std::filesystem::path folder; ///< for runs and results
  std::size_t jobs = 1;         ///< runs at once, each in a process
  int threads_per_run = 1;
  std::vector<std::string> quantities{}; ///< of keeler analyze, as additional columns
  std::function<void(const Progress&)> progress;
  std::function<void(const std::string&)> notice;
};

/// Executes runs until every run is finished, has failed or is held by another program. A failure is recorded in the
/// folder, and the run is not tried again before the next call, neither here nor by concurrent programs. On a stop
/// request the runs are stopped, each with a checkpoint. Precondition: settings.jobs > 0, and `progress` and `notice`
/// are set. Throws IoError, Error.
void work_on(std::span<const PlannedRun> runs, const RunFolders& folders, Claims& claims, const BatchSettings& settings,
             const runs::RunRequests& requests);

} // namespace keeler::batch
