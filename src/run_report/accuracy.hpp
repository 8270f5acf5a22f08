// How exact a run was, and what each part of it cost.
#pragma once

#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>

#include <string>

namespace keeler {

/// What was approximated, by how much, and its share of the time. `summary` is the run's summary.json.
std::string accuracy_table(const Scene& scene, const Record& summary);

/// Where the wall time went.
std::string timing_table(const Record& summary);

} // namespace keeler
