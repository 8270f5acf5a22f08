// summary.json: the results and costs of a run, as named numbers.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <filesystem>

namespace keeler::runs {

/// Returns names, units and meanings, in the order of a summary. For each external force a run also has `split.NAME_s`.
std::vector<quantities::Quantity> summary_quantities();

/// Reads the summary in a run's folder, also one of an earlier version. Throws IoError when it is missing or invalid.
quantities::Record read_summary(const std::filesystem::path& folder);

} // namespace keeler::runs
