// The tables of numbers on the page.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>

#include <string>

namespace keeler::run_report {

/// Returns the quantities that follow from the scene and the patch of a run. Precondition: the patch is not empty.
std::string derived_table(const Scene& scene, const Patch& patch);

/// Returns the numbers of `keeler analyze`, with errors.
std::string measured_table(const quantities::Record& numbers, std::optional<quantities::UnitSystem> system);

/// Returns all numbers, by their names in `keeler analyze --json`.
std::string all_numbers(const quantities::Record& numbers);

/// Returns a table of the approximations, their errors and their fractions of the wall time. `summary` is summary.json.
std::string accuracy_table(const Scene& scene, const quantities::Record& summary);

/// Returns a table of the wall time by parts.
std::string timing_table(const quantities::Record& summary);

} // namespace keeler::run_report
