// The keys of a checked scene, one by one.
#pragma once

#include <keeler/scene/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::scene {

/// A key of the resolved scene.
struct KeyInForce {
  std::string path;                ///< "time.end", "moonlet[2].radius"
  std::string value;               ///< as TOML
  std::optional<std::string> file; ///< absolute path, if the value is the path of a file
};

/// Returns every key of the resolved scene, in its order.
std::vector<KeyInForce> keys_in_force(const Scene& scene);

} // namespace keeler::scene
