// The numbers of a measurement, and the paper's claims about them.
#pragma once

#include "report.hpp"

#include <string>
#include <vector>

namespace keeler::study {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>; ///< a table with its header row first

/// Returns a number of a measurement by its key. Throws nlohmann::json::exception when it is missing.
inline double of(const Json& json, const std::string& key) {
  return json.at(key).get<double>();
}

std::string number(double value);     ///< formats with three digits
std::string percent(double fraction); ///< formats 1 as "100.0 %"

/// Returns the number of calls of an audited run that ended with one of these exits.
double calls_ended(const Json& audit, const std::vector<std::string>& exits);

/// Returns the fraction of the calls with these exits that took at least `min_iterations`.
double fraction_from(const Json& audit, const std::vector<std::string>& exits, std::size_t min_iterations);

/// Returns the mean of "iterations" or "evaluations" over the calls with one exit.
double mean_over(const Json& audit, const std::string& exit, const char* field);

/// Returns a table of the paper's claims, the measurements, and the verdicts.
Rows paper_claims(const FinderStudyData& data);

} // namespace keeler::study
