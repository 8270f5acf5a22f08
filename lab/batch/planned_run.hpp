// A run of a sweep or study: its name, its validated scene, and the point of the parameter grid that it belongs to.
#pragma once

#include <keeler/scene/scene.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace keeler::batch {

struct PlannedRun {
  std::string name;      ///< name of its folder; determined by the settings and the seed alone
  std::size_t point = 0; ///< index of the settings; runs of one point differ only in their seeds
  std::uint64_t seed = 0;
  Scene scene;
};

} // namespace keeler::batch
