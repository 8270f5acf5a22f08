// The table of everything that a scene file may say. It is the single source: checking, suggestions, the resolved
// scene, `keeler check --defaults`, the manual's table and the state hash all read it. Restitution laws, size laws and
// forces bring their keys with their entry in their own registry; every other new key is one entry here.
#pragma once

#include <keeler/core/key.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace keeler {

/// A table of the scene file.
struct Section {
  std::string path;
  bool needed = false;
  std::string meaning{};
  std::string replaced_by{}; ///< a key that takes the section's place: with it the section must be absent
  bool repeated = false;     ///< a list of tables, [[path]]: table n of it is path[n], from 1, and has keys path[n].key
  std::size_t most = 1;      ///< tables in the list

  /// As it is written in a scene.
  std::string header() const { return repeated ? "[[" + path + "]]" : "[" + path + "]"; }
};

/// In the order of the manual; the keys of a sub-table follow those of its table.
const std::vector<Key>& scene_keys();
const std::vector<Section>& scene_sections();

/// Both also take a path in a list of tables: moonlet[2].radius has the declaration of moonlet.radius.
const Key* find_key(const std::string& path);
const Section* find_section(const std::string& path);

/// Without the numbers of tables in lists.
std::string declared_path(const std::string& path);

/// What a value must be, in words: "a number above 0", "one of direct, tree".
std::string allowed_words(const Key& key);

} // namespace keeler
