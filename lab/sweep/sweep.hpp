// Parameter sweeps: runs of one scene on a grid of keys times seeds, several at once, each in a separate folder, with
// tables and a figure of the measured quantities. Repeating the call continues a sweep that was stopped or killed;
// programs on any number of machines may work in one folder.
//
// docs/manual/commands.md describes the grid file, docs/formats.md the folder.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/runs/run.hpp>

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace keeler {

struct SweepSettings {
  std::filesystem::path grid;
  std::filesystem::path folder;
  std::size_t jobs = 1; ///< runs at once, each in a process
  int threads_per_run = 1;
  bool tables_only = false;              ///< start no run, only write the tables of finished runs
  std::vector<std::string> quantities{}; ///< of keeler analyze, as additional columns
  std::function<void(const Progress&)> progress;
  std::function<void(const std::string&)> notice;
};

/// The state of the folder after a call.
struct SweepResult {
  std::size_t runs = 0, finished = 0, failed = 0;       ///< number of runs of the grid
  std::size_t unmeasurable = 0;                         ///< failed runs that ended normally but have unreadable files
  bool began = false;                                   ///< starting runs was requested
  bool stopped = false;                                 ///< on request; the tables were not written
  std::shared_ptr<const nlohmann::ordered_json> points; ///< the rows of points.csv, a list; null if there are none
  std::string figure_fault;                             ///< reason why drawing the figure failed; empty if it did not
};

/// Executes the runs that are neither finished nor held by another program, and writes the tables. All input is checked
/// before anything is written. Throws UsageError when the grid or one of its scenes is invalid, or when the folder
/// holds other files or runs with other settings; IoError.
SweepResult sweep(const SweepSettings& settings, const RunRequests& requests);

} // namespace keeler
