// The accuracy of a run, and the cost of its parts.
#pragma once

#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>

#include <string>

namespace keeler::run_report {

/// Returns a table of the approximations, their errors and their fractions of the wall time. `summary` is summary.json.
std::string accuracy_table(const Scene& scene, const quantities::Record& summary);

/// Returns a table of the wall time by parts.
std::string timing_table(const quantities::Record& summary);

} // namespace keeler::run_report
