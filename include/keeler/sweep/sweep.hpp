// Many runs of one scene: a grid of keys times seeds, each run in a folder of its own, several at once, and tables and
// a figure of what they measure. A sweep that was stopped or killed goes on with the same call; programs on any number
// of machines may work in one folder.
//
// docs/manual/commands.md has the file of a grid, docs/formats.md the folder.
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
  std::size_t jobs = 1; ///< runs at once, each a process
  int threads_per_run = 1;
  bool tables_only = false;              ///< start nothing, make the tables of what is finished
  std::vector<std::string> quantities{}; ///< of keeler analyze, as columns besides those of every sweep
  std::function<void(const Progress&)> progress;
  std::function<void(const std::string&)> notice;
};

/// How the folder stands.
struct SweepResult {
  std::size_t runs = 0, finished = 0, failed = 0; ///< of the grid
  std::size_t unmeasurable = 0; ///< failed ones that came to their end, but whose files cannot be read
  bool began = false;           ///< runs were to be started
  bool stopped = false;         ///< on request; the tables were not made
  std::shared_ptr<const nlohmann::ordered_json> points; ///< the rows of points.csv, a list; null where there are none
  std::string figure_fault; ///< why the figure could not be drawn, where it should have been
};

/// Carries out the runs that are neither finished nor held by another program, and makes the tables. Everything is
/// checked before anything is written. Throws UsageError when the grid or a scene of it is wrong, or when the folder
/// holds something else or runs of other settings; IoError.
SweepResult sweep(const SweepSettings& settings, const RunRequests& requests);

} // namespace keeler
