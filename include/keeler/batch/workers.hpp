// Carries out a list of runs, several at once, each as a process of its own. Any number of programs may do so in one
// folder: each takes the next run that is not finished and that nobody holds.
#pragma once

#include <keeler/batch/claims.hpp>
#include <keeler/batch/planned_run.hpp>
#include <keeler/batch/run_folders.hpp>
#include <keeler/core/progress.hpp>
#include <keeler/runs/run.hpp>

#include <functional>
#include <span>
#include <string>

namespace keeler {

struct WorkOptions {
  std::size_t jobs = 1; ///< runs at once
  int threads = 1;      ///< of each run
  std::function<void(const Progress&)> progress;
  std::function<void(const std::string&)> notice;
};

/// Returns when there is nothing left to take: all is finished, has failed or is held by other programs. A run that
/// fails is noted in the folder; it is not tried again, here or by a program that works beside, until the next call.
/// When the requests ask to stop, the runs are stopped with a checkpoint first. Throws IoError, Error.
void work_on(std::span<const PlannedRun> runs, const RunFolders& folders, Claims& claims, const WorkOptions& options,
             const RunRequests& requests);

} // namespace keeler
