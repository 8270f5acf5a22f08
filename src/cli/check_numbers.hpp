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

namespace keeler::cli {

/// A scene with its derived quantities.
struct CheckedScene {
  const Scene& scene;
  scene::PatchScale start; ///< of the start file, if there is one
  advice::Derived derived;
  std::optional<advice::RunEstimate> cost; ///< none: the particles come from a start file
  std::vector<std::string> warnings;
};

quantities::Record record_of(const CheckedScene& checked);
std::vector<quantities::Quantity> check_quantities();

} // namespace keeler::cli
