// Output of the finder study: tables, figures and the report, made from its measurements.
#pragma once

#include "job_list.hpp"
#include "states.hpp"
#include "step_law.hpp"

namespace keeler::study {

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
  double cpu(const std::string& state, double step, const std::string& finder) const {
    return timed(state, step, finder, "cpu_s");
  }
  /// Returns the time per call at the shown step, ns.
  double per_call(const std::string& state, const std::string& finder) const {
    return timed(state, shown_step, finder, "ns_per_call");
  }
  /// Returns the fraction of a run's time that a replay of recorded answers saves.
  double finder_fraction(const std::string& state, const std::string& finder) const;
  /// Returns the scatter of the times: half the range of the repeats over their median, as median over all timed runs.
  double scatter() const;
  /// Returns the audited run of the first state (equal sizes, early) at the shown step.
  const Json& early(const std::string& finder) const { return audit(states.front().name, shown_step, finder); }
  /// Returns a measurement at the shown step: "details", "rejection".
  const Json& shown(const std::string& kind, const std::string& state) const;
  const Json& local(double step, double moved_fraction) const;
  std::size_t best_step(const std::string& state, const std::string& finder) const; ///< index of the fastest step
  StepLaw law_of(const std::string& state, const std::string& finder) const;

  int panels() const { return static_cast<int>(states.size() * steps.size()); }
  /// Calls visit(state, step) for each panel: state × step.
  template<class Visit> void each_panel(const Visit& visit) const {
    for (const StudyState& state : states)
      for (const double step : steps)
        visit(state.name, step);
  }
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

} // namespace keeler::study
