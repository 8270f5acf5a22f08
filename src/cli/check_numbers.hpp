// The table of the numbers of keeler check.
#pragma once

#include <keeler/advice/derived.hpp>
#include <keeler/advice/estimate.hpp>
#include <keeler/quantities/quantity.hpp>
#include <keeler/scene/patch_scale.hpp>
#include <keeler/scene/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// A scene with its derived quantities.
struct CheckedScene {
  const Scene& scene;
  PatchScale start; ///< of the start file, if there is one
  Derived derived;
  std::optional<RunEstimate> cost; ///< none: the particles come from a start file
  std::vector<std::string> warnings;
};

Record record_of(const CheckedScene& checked);
std::vector<Quantity> check_quantities();

} // namespace keeler
