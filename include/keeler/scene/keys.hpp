// The table of everything that a scene file may say. It is the single source: checking, suggestions, the resolved
// scene, `keeler check --defaults`, the manual's table and the state hash all read it. Restitution laws, size laws and
// forces bring their keys with their entry in their own registry; every other new key is one entry here.
#pragma once

#include <keeler/core/key.hpp>

#include <string>
#include <vector>

namespace keeler {

/// A table of the scene file.
struct Section {
  std::string path;
  bool needed = false;
  std::string meaning{};
  std::string replaced_by{}; ///< a key that takes the section's place: with it the section must be absent
};

/// In the order of the manual; the keys of a sub-table follow those of its table.
const std::vector<Key>& scene_keys();
const std::vector<Section>& scene_sections();

const Key* find_key(const std::string& path);
const Section* find_section(const std::string& path);

/// What a value must be, in words: "a number above 0", "one of direct, tree".
std::string allowed_words(const Key& key);

} // namespace keeler
