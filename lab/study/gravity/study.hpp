// The gravity solvers in a patch of Saturn's A ring: error against cost for many settings of each, and whether the
// physics of wakes depends on the solver or on the kick interval.
//
// The folder holds study.json (the options), measurements.jsonl (one line per measurement, written at once, so that the
// same command continues after a stop), gravity.csv (one row per setting), gravity_runs.csv (one row per run),
// gravity.json (both), figures/, report.md and report.html.
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
  std::size_t count = 100000;         ///< particles of the state for the force errors
  int repeats = 5;                    ///< of each time measurement
  double orbits = 4.0;                ///< measured part of each run
  int seeds = 3;                      ///< runs per solver and kick interval; at least 2
  std::vector<std::string> arguments; ///< the command line, for provenance
  std::function<void(const std::string&)> notice;
  std::function<void(const Progress&)> progress;
};

/// Carries out the missing measurements and writes the report. Returns false if `stop` was set; a later call with the
/// same settings continues. Throws UsageError when the folder holds a study with other options, and IoError.
bool study_gravity(const GravityStudySettings& settings, const std::atomic<bool>& stop);

} // namespace keeler
