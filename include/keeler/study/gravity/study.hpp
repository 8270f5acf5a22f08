// The gravity solvers in a patch of Saturn's A ring: error against cost for many settings of each, and whether the
// physics of wakes depends on the solver or on the kick interval.
//
// The folder holds study.json and measurements.jsonl (the options, one line a measurement, kept at once: the same
// command goes on where it was stopped), gravity.csv (a row a setting), gravity_runs.csv (a row a run), gravity.json
// (both), figures/, report.md and report.html.
#pragma once

#include <keeler/core/progress.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace keeler {

struct GravityStudySettings {
  std::filesystem::path folder;
  std::size_t count = 100000;         ///< of the state whose forces are worked out
  int repeats = 5;                    ///< of each timing
  double orbits = 4.0;                ///< that each run is measured over
  int seeds = 3;                      ///< runs with each solver and kick interval; at least 2
  std::vector<std::string> arguments; ///< the command line, for provenance
  std::function<void(const std::string&)> notice;
  std::function<void(const Progress&)> progress;
};

/// Carries out what is missing and writes the report. Returns false when `stop` was set: the folder can be continued.
/// Throws UsageError when the folder holds a study of other options, IoError.
bool study_gravity(const GravityStudySettings& settings, const std::atomic<bool>& stop);

} // namespace keeler
