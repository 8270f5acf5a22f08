// Output of the gravity study: tables, figures and the report, made from its measurements.
#pragma once

#include "job_list.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace keeler {

/// The data of tables, figures and report.
struct GravityStudyData {
  std::filesystem::path folder;
  Json bench;                                    ///< `rows`, one per setting, and the numbers of the state
  std::map<std::string, std::vector<Json>> runs; ///< one result per seed, by run_label()
  double orbits = 0.0;                           ///< measured part of each run
  std::map<std::string, std::string> made;       ///< command, host, processor, compiler, flags, commit

  /// Returns the rows of one solver, in the order of measurement.
  std::vector<Json> rows_of(const std::string& solver) const;
  std::vector<std::string> solvers() const;
};

/// Returns the rows that no other row beats in both error and cost, by rising cost.
std::vector<Json> pareto_front(const Json& rows);

/// Returns p of error ~ parameter^p, the least-squares slope of the logarithms.
/// Precondition: at least two rows with different parameters; parameters and errors are positive.
double convergence_order(const std::vector<Json>& rows);

/// Writes gravity.csv, gravity_runs.csv and gravity.json.
void write_gravity_tables(const GravityStudyData& data);

/// Writes report.md and report.html.
void write_gravity_report(const GravityStudyData& data, bool with_figures);

} // namespace keeler
