// What was measured in a run, as tables of the page.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace keeler {

/// What follows from the scene and the patch of a run.
std::string derived_table(const Scene& scene, const Patch& patch);

/// The numbers that a ring scientist asks for first, with errors. `numbers` are those of `keeler analyze --json`.
std::string measured_tables(const nlohmann::ordered_json& numbers);

/// Every single one of them, by its name there.
std::string all_numbers(const nlohmann::ordered_json& numbers);

} // namespace keeler
