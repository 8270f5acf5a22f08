// An analysis under the names of `keeler analyze --json`.
#pragma once

#include <keeler/diagnostics/analysis.hpp>

#include <nlohmann/json.hpp>

namespace keeler {

/// `largest_overlap` is that of all its snapshots, of a radius sum.
nlohmann::ordered_json numbers_of(const Analysis& analysis, double largest_overlap);

} // namespace keeler
