// What `keeler analyze` prints of the structure in snapshots: wakes, local motions, clusters.
#pragma once

#include <keeler/diagnostics/analysis.hpp>

#include <nlohmann/json.hpp>

namespace keeler {

/// Adds the JSON names of the structure.
void add_structure(nlohmann::ordered_json& json, const Analysis& analysis);

/// The same as text.
void print_structure(const Analysis& analysis);

} // namespace keeler
