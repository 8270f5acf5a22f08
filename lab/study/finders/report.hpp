// Output of the finder study: tables, figures and the report, made from its measurements.
#pragma once

#include "job_list.hpp"
#include "states.hpp"

namespace keeler {

/// The data of tables, figures and report.
struct FinderStudyData {
  std::filesystem::path folder;
  std::vector<StudyState> states;
  std::vector<double> steps;
  double shown_step = 1e-3; ///< orbits; of the histograms and the comparisons per call
  int repeats = 0;
  std::vector<double> moved_fractions;     ///< of the particles, for local_times()
  std::map<std::string, Json> results;     ///< by job_name()
  std::map<std::string, std::string> made; ///< command, host, processor, compiler, flags, commit of the timed runs

  const Json& audit(const std::string& state, double step, const std::string& finder) const;
  const Json& result(const std::string& name) const { return results.at(name); }
  /// Returns a field of the timed runs, one value per repeat; timed() returns the median of these.
  std::vector<double> repeated(const std::string& state, double step, const std::string& finder,
                               const char* field) const;
  double timed(const std::string& state, double step, const std::string& finder, const char* field) const;
};

/// Returns the name of a job: "kind/state/step[/finder][/repeat]". It is a key of measurements.jsonl.
std::string job_name(const std::string& kind, const std::string& state, double step, const std::string& finder = "",
                     int repeat = -1);

/// Writes finders.csv and finders.json, one row per timed run.
void write_finder_tables(const FinderStudyData& data);

/// Draws figures/figure1 … figure6 and the figure of the local times, and writes figure1.csv. Throws IoError.
void draw_finder_figures(const FinderStudyData& data);

/// Writes report.md and report.html.
void write_finder_report(const FinderStudyData& data, bool with_figures);

} // namespace keeler
