// summary.json: what a run came to, as numbers with names.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <filesystem>

namespace keeler {

/// Names, units and meanings, in the order of a summary. Runs with external forces have a `split.NAME_s` for each
/// besides.
std::vector<Quantity> summary_quantities();

/// Of a run's folder, also one of former versions. Throws IoError where there is none, or where it holds something
/// else.
Record read_summary(const std::filesystem::path& folder);

} // namespace keeler
