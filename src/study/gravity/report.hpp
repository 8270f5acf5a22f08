// From the measurements of the gravity study to tables, figures and the report.
#pragma once

#include "job_list.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keeler {

/// All that the report is made of.
struct GravityStudyData {
  std::filesystem::path folder;
  Json bench;                                    ///< `rows`, and the numbers of the state
  std::map<std::string, std::vector<Json>> runs; ///< a result a seed, by run_label()
  double orbits = 0.0;                           ///< that runs were measured over
  std::map<std::string, std::string> made;       ///< command, host, processor, compiler, flags, commit

  /// The rows of one solver, in the order measured.
  std::vector<Json> rows_of(const std::string& solver) const;
  std::vector<std::string> solvers() const;
};

/// The rows that no other row beats both in error and in cost, by rising cost.
std::vector<Json> pareto_front(const Json& rows);

/// p of error ~ parameter^p: the slope of a straight line through the logarithms, least squares; at least two rows
/// with different parameters.
double convergence_order(const std::vector<Json>& rows);

/// figures/pareto and figures/convergence, as PNG and SVG; returns false, and leaves only their data, when there is no
/// gnuplot.
bool draw_gravity_figures(const GravityStudyData& data);

/// gravity.csv, gravity_runs.csv and gravity.json.
void write_gravity_tables(const GravityStudyData& data);

/// report.md and report.html.
void write_gravity_report(const GravityStudyData& data, bool with_figures);

} // namespace keeler
