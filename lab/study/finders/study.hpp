// The complete experiment of M. C. Lewis, "Collision Finding for Particles on Non-linear Paths" (draft): four states ×
// finders × time steps × repeats, each run a tenth of an orbit. The study times every run, compares every answer with
// the certified finder's, and measures the questions that the paper left open.
//
// The folder holds states/ (the four states), measurements.jsonl (one line per measurement, written at once, so that
// the same command continues after a stop), finders.csv and finders.json (one row per timed run), figures/, report.md
// and report.html.
#pragma once

#include <keeler/core/progress.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace keeler::study {

struct FinderStudySettings {
  std::filesystem::path folder;
  std::size_t count = 10000; ///< particles of equal size; the states with a size distribution have half as many
  bool quick = false;        ///< fewer particles, steps and repeats: minutes instead of an hour and a half
  std::vector<std::string> arguments; ///< the command line, for provenance
  std::function<void(const std::string&)> notice;
  std::function<void(const Progress&)> progress;
};

/// Carries out the missing measurements and writes the report. Returns false if `stop` was set; a later call with the
/// same settings continues. Throws UsageError when the folder holds a study with other settings, and IoError.
bool study_finders(const FinderStudySettings& settings, const std::atomic<bool>& stop);

} // namespace keeler::study
