// The numbers of the finder study's report and figures, computed from the measurements.
#pragma once

#include "json_value.hpp"
#include "report.hpp"
#include "step_law.hpp"

#include <string>
#include <vector>

namespace keeler {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>; ///< a table with its header row first

std::string number(double value);     ///< formats with three digits
std::string percent(double fraction); ///< formats 1 as "100.0 %"

/// Returns the number of calls of an audited run that ended with one of these exits.
double calls_ended(const Json& audit, const std::vector<std::string>& exits);

/// Returns the fraction of the calls with these exits that took at least `min_iterations`.
double fraction_from(const Json& audit, const std::vector<std::string>& exits, std::size_t min_iterations);

/// Returns the mean of "iterations" or "evaluations" over the calls with one exit.
double mean_over(const Json& audit, const std::string& exit, const char* field);

class FinderNumbers {
public:
  explicit FinderNumbers(const FinderStudyData& measured) : data(measured) {}

  const FinderStudyData& data;

  double cpu(const std::string& state, double step, const std::string& finder) const {
    return data.timed(state, step, finder, "cpu_s");
  }
  /// Returns the time per call at the shown step, ns.
  double per_call(const std::string& state, const std::string& finder) const {
    return data.timed(state, data.shown_step, finder, "ns_per_call");
  }
  /// Returns the fraction of a run's time that a replay of recorded answers saves.
  double finder_fraction(const std::string& state, const std::string& finder) const;
  /// Returns the scatter of the times: half the range of the repeats over their median, as median over all timed runs.
  double scatter() const;
  /// Returns the audited run of the first state (equal sizes, early) at the shown step.
  const Json& early(const std::string& finder) const {
    return data.audit(data.states.front().name, data.shown_step, finder);
  }
  const Json& details(const std::string& state) const {
    return data.result(job_name("details", state, data.shown_step));
  }
  const Json& rejection(const std::string& state) const {
    return data.result(job_name("rejection", state, data.shown_step));
  }
  const Json& local(double step, double moved_fraction) const;
  std::size_t best_step(const std::string& state, const std::string& finder) const; ///< index of the fastest step
  StepLaw law_of(const std::string& state, const std::string& finder) const;

  int panels() const { return static_cast<int>(data.states.size() * data.steps.size()); }
  /// Calls visit(state, step) for each panel: state × step.
  template<class Visit> void each_panel(const Visit& visit) const {
    for (const StudyState& state : data.states)
      for (const double step : data.steps)
        visit(state.name, step);
  }
};

/// Returns a table of the paper's claims, the measurements, and the verdicts.
Rows paper_claims(const FinderNumbers& numbers);

} // namespace keeler
