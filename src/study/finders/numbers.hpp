// The numbers that the finder study's report and figures are made of, taken from the measurements.
#pragma once

#include "json_value.hpp"
#include "report.hpp"
#include "step_law.hpp"

#include <string>
#include <vector>

namespace keeler {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>; ///< a table, its head first

std::string number(double value);  ///< three digits
std::string percent(double share); ///< of one

/// Calls of an audited run that ended for these reasons.
double calls_ended(const Json& audit, const std::vector<std::string>& exits);

/// Share of those calls that took `least` iterations or more.
double share_from(const Json& audit, const std::vector<std::string>& exits, std::size_t least);

/// Mean of "iterations" or "evaluations" over the calls with one exit.
double mean_over(const Json& audit, const std::string& exit, const char* field);

class FinderNumbers {
public:
  explicit FinderNumbers(const FinderStudyData& measured) : data(measured) {}

  const FinderStudyData& data;

  double cpu(const std::string& state, double step, const std::string& finder) const {
    return data.timed(state, step, finder, "cpu_s");
  }
  double per_call(const std::string& state, const std::string& finder) const { // at the step that is shown
    return data.timed(state, data.shown_step, finder, "ns_per_call");
  }
  /// Of a run's time, what a run on recorded answers does not need.
  double finder_fraction(const std::string& state, const std::string& finder) const;
  /// Half the range of the repeats over their median; its median over all timed runs.
  double scatter() const;
  /// The audited run of the first state, equal sizes and early, at the step that is shown.
  const Json& early(const std::string& finder) const {
    return data.audit(data.states.front().name, data.shown_step, finder);
  }
  const Json& details(const std::string& state) const {
    return data.result(job_name("details", state, data.shown_step));
  }
  const Json& rejection(const std::string& state) const {
    return data.result(job_name("rejection", state, data.shown_step));
  }
  const Json& local(double step, double share) const;
  std::size_t best_step(const std::string& state, const std::string& finder) const; ///< place among the steps
  StepLaw law_of(const std::string& state, const std::string& finder) const;

  int panels() const { return static_cast<int>(data.states.size() * data.steps.size()); }
  template<class Visit> void each_panel(const Visit& visit) const { // state × step
    for (const StudyState& state : data.states)
      for (const double step : data.steps)
        visit(state.name, step);
  }
};

/// Each claim of the paper, what was measured, and a verdict.
Rows paper_claims(const FinderNumbers& numbers);

} // namespace keeler
