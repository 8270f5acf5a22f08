// The gravity solvers in a patch of Saturn's A ring: error against cost for many settings of each.
//
// The folder holds study.json and measurements.jsonl (the options, one line a measurement, kept at once: the same
// command goes on where it was stopped), gravity.csv and gravity.json (a row a setting), figures/, report.md and
// report.html.
#pragma once

#include <keeler/study/progress.hpp>

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
  std::vector<std::string> arguments; ///< the command line, for provenance
  std::function<void(const std::string&)> notice;
  std::function<void(const StudyProgress&)> progress;
};

/// Carries out what is missing and writes the report. Returns false when `stop` was set: the folder can be continued.
/// Throws UsageError when the folder holds a study of other options, IoError.
bool study_gravity(const GravityStudySettings& settings, const std::atomic<bool>& stop);

} // namespace keeler
