// What keeler check tells of a scene, as numbers with names.
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

/// A scene and what follows from it.
struct CheckedScene {
  const Scene& scene;
  PatchScale start; ///< of the start file where there is one
  Derived derived;
  std::optional<RunEstimate> cost; ///< none: only the start file knows the particles
  std::vector<std::string> warnings;
};

Record record_of(const CheckedScene& checked);
std::vector<Quantity> check_quantities();

} // namespace keeler
