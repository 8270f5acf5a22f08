// A run that a list of runs asks for: its name, its checked scene, and which of the list's settings it shows.
#pragma once

#include <keeler/scene/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace keeler {

struct PlannedRun {
  std::string name;      ///< of its folder: the same settings and seed have the same name in every list
  std::size_t point = 0; ///< which settings; runs of one point differ in their seed
  std::uint64_t seed = 0;
  Scene scene;
};

} // namespace keeler
