// What a checked scene says, key by key.
#pragma once

#include <keeler/scene/scene.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// A key of the resolved scene.
struct KeyInForce {
  std::string path;                ///< "time.end", "moonlet[2].radius"
  std::string value;               ///< as TOML
  std::optional<std::string> file; ///< the absolute path of the file that the value names, if it names one
};

/// Returns every key of the resolved scene, in its order.
std::vector<KeyInForce> keys_in_force(const Scene& scene);

} // namespace keeler
