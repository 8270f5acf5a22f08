// How exact a run was, and what each part of it cost.
#pragma once

#include <keeler/scene/scene.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace keeler {

/// What was approximated, by how much, and its share of the time. `summary` is the run's summary.json.
std::string accuracy_table(const Scene& scene, const nlohmann::ordered_json& summary);

/// Where the wall time went.
std::string timing_table(const nlohmann::ordered_json& summary);

} // namespace keeler
