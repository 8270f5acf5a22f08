// What a document may contain: its tables (sections) and their keys. Checks, suggestions, defaults and the resolved
// text are views of it.
#pragma once

#include <keeler/core/key.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace keeler::config {

/// A table of a document.
struct Section {
  std::string path;
  bool needed = false;
  std::string meaning{};
  std::string replaced_by{};       ///< a key that takes the section's place: with it the section must be absent
  bool repeated = false;           ///< a list of tables, [[path]]: table n is path[n], from 1, with keys path[n].key
  std::size_t max_count = 1;       ///< upper limit of the tables in the list
  bool defaults_if_absent = false; ///< the defaults of its keys are in force even where the table is absent
  std::string former_path{}; ///< an earlier path, which documents may still use; of one table, without hashed keys

  /// Returns the header as a document writes it.
  std::string header() const { return repeated ? "[[" + path + "]]" : "[" + path + "]"; }
};

/// All keys and sections. Guarantees that no path occurs twice.
class Schema {
public:
  Schema() = default;
  /// Precondition: paths are unique; the keys of a sub-table follow the keys of its table.
  Schema(std::vector<Key> keys, std::vector<Section> sections);

  /// Returns the keys in the order of the resolved text and of the manual.
  const std::vector<Key>& keys() const { return keys_; }
  const std::vector<Section>& sections() const { return sections_; }

  /// Returns the path with the present names of a table and a key that it calls by former names.
  std::string current_path(std::string path) const;

  /// Returns the declaration for a path, nullptr if there is none. The path may lie in a list of tables:
  /// moonlet[2].radius has the declaration of moonlet.radius. find_key() accepts former names.
  const Key* find_key(const std::string& path) const;
  const Section* find_section(const std::string& path) const;

private:
  std::vector<Key> keys_;
  std::vector<Section> sections_;
};

/// Returns the path without the indices of tables in lists.
std::string declared_path(const std::string& path);

/// Returns in words what a value must be: "a number above 0", "one of "direct", "tree"".
std::string allowed_words(const Key& key);

} // namespace keeler::config
