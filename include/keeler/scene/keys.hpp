// The table of everything that a scene file may say. It is the single source: checking, suggestions, the resolved
// scene, `keeler check --defaults` and the manual's table all read it, so a new key is one entry here.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace keeler {

enum class KeyType { text, path, choice, number, integer, pair };

/// Allowed numbers; an open end is excluded.
struct KeyRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  bool contains(double value) const;
  /// "above 0", "from 0 to 1", …; empty when everything is allowed.
  std::string words() const;
};

/// A key that has a meaning only when another one is given, and has one of `values` where there are any.
struct KeyCondition {
  std::string key;
  std::vector<std::string> values;

  bool allows(const std::string& value) const;
  /// " = "a" or "b"", or nothing.
  std::string words() const;
};

struct Key {
  std::string path; ///< "particles.sizes.radius"
  KeyType type = KeyType::text;
  std::string fallback{}; ///< the default as TOML; empty: the key is needed where its section and condition hold
  std::string example{};  ///< TOML, for messages, where there is no default
  std::string unit{};
  std::string meaning{};
  KeyRange range{};
  std::vector<std::string> choices{};
  std::vector<std::string> alternatives{}; ///< exactly one of this key and these is given
  KeyCondition only_with{};

  std::string section() const { return path.substr(0, path.rfind('.') == std::string::npos ? 0 : path.rfind('.')); }
  std::string name() const { return path.substr(path.rfind('.') == std::string::npos ? 0 : path.rfind('.') + 1); }
};

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
