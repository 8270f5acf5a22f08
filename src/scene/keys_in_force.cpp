#include <keeler/scene/keys_in_force.hpp>

#include <keeler/config/document.hpp>
#include <keeler/scene/keys.hpp>

namespace keeler::scene {

std::vector<KeyInForce> keys_in_force(const Scene& scene) {
  std::vector<KeyInForce> keys;
  for (const config::DocumentEntry& entry : parse_document(scene.resolved, "the resolved scene", scene_schema())) {
    const Key* const key = find_key(entry.path);
    if (!key)
      continue; // the header of a table
    keys.push_back({entry.path, config::to_toml(entry.value), std::nullopt});
    const auto* const text = std::get_if<std::string>(&entry.value);
    if (text && (key->type == KeyType::path || key->type == KeyType::rows))
      keys.back().file = *text;
  }
  return keys;
}

} // namespace keeler::scene
