// What was measured in a run, as tables of the page.
#pragma once

#include <keeler/particles/patch.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/scene.hpp>

#include <string>

namespace keeler {

/// What follows from the scene and the patch of a run.
std::string derived_table(const Scene& scene, const Patch& patch);

/// The numbers of `keeler analyze`, with errors.
std::string measured_table(const Record& numbers);

/// Every single one of them, by its name in `keeler analyze --json`.
std::string all_numbers(const Record& numbers);

} // namespace keeler
