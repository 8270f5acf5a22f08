// The paper's experiment (M. C. Lewis, "Collision Finding for Particles on Non-linear Paths", draft), in full: four
// states × finders × time steps × repeats, each a tenth of an orbit, with the truth of every call beside the times, and
// the questions that the paper left open.
//
// The folder holds states/ (the four states), measurements.jsonl (one line a measurement, kept at once: the same
// command goes on where it was stopped), finders.csv and finders.json (a row a timed run), figures/, report.md and
// report.html.
#pragma once

#include <keeler/core/progress.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace keeler {

struct FinderStudySettings {
  std::filesystem::path folder;
  std::size_t count = 10000; ///< particles of equal size; the states with a size distribution have half as many
  bool quick = false;        ///< fewer particles, steps and repeats: minutes instead of an hour and a half
  std::vector<std::string> arguments; ///< the command line, for provenance
  std::function<void(const std::string&)> notice;
  std::function<void(const Progress&)> progress;
};

/// Carries out what is missing and writes the report. Returns false when `stop` was set: the folder can be continued.
/// Throws UsageError when the folder holds a study of other settings, IoError.
bool study_finders(const FinderStudySettings& settings, const std::atomic<bool>& stop);

} // namespace keeler
