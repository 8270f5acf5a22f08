// The schema of scene files. It is the single source: checking, suggestions, the resolved scene, `keeler check
// --defaults`, the manual's table and the state hash all read it. Restitution laws, size laws and forces declare their
// keys with their entry in their own registry; every other new key is one entry of key_table.cpp.
#pragma once

#include <keeler/config/schema.hpp>

#include <string>
#include <vector>

namespace keeler::scene {

/// Returns every key and table of a scene, in the order of the manual.
const config::Schema& scene_schema();

inline const std::vector<Key>& scene_keys() {
  return scene_schema().keys();
}
inline const std::vector<config::Section>& scene_sections() {
  return scene_schema().sections();
}
inline const Key* find_key(const std::string& path) {
  return scene_schema().find_key(path);
}
inline const config::Section* find_section(const std::string& path) {
  return scene_schema().find_section(path);
}

/// Returns every key with default, unit and meaning, as a text table or as the manual's Markdown table.
std::string describe_keys(bool markdown);

/// Returns the same text table of the keys with this path, such as "gravity.solver", or its last part, or in a table of
/// this name, such as "friction"; empty if there are none.
std::string describe_keys_called(const std::string& name);

} // namespace keeler::scene
