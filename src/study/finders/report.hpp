// From the measurements of the finder study to tables, figures and the report.
#pragma once

#include "job_list.hpp"
#include "states.hpp"

namespace keeler {

/// All that the report is made of.
struct FinderStudyData {
  std::filesystem::path folder;
  std::vector<StudyState> states;
  std::vector<double> steps;
  double shown_step = 1e-3; ///< of the histograms and of the comparisons per call
  int repeats = 0;
  std::vector<double> shares; ///< of particles moved, for the local times
  std::map<std::string, Json> results;
  std::map<std::string, std::string> made; ///< command, host, processor, compiler, flags, commit of the timed runs

  const Json& audit(const std::string& state, double step, const std::string& finder) const;
  const Json& result(const std::string& name) const { return results.at(name); }
  /// A field of the timed runs, one value a repeat, and its median.
  std::vector<double> repeated(const std::string& state, double step, const std::string& finder,
                               const char* field) const;
  double timed(const std::string& state, double step, const std::string& finder, const char* field) const;
};

/// How a job is named.
std::string job_name(const std::string& kind, const std::string& state, double step, const std::string& finder = "",
                     int repeat = -1);

/// finders.csv and finders.json: a row a timed run.
void write_finder_tables(const FinderStudyData& data);

/// figures/figure1 … figure6 and those of the open questions, as PNG and SVG; returns false, and leaves only their
/// data, when there is no gnuplot.
bool draw_finder_figures(const FinderStudyData& data);

/// report.md and report.html.
void write_finder_report(const FinderStudyData& data, bool with_figures);

} // namespace keeler
