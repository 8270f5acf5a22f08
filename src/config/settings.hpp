// The values in force: a checked document, and defaults for all other keys.
#pragma once

#include <keeler/config/document.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/key.hpp>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <string>

namespace keeler::config {

class Settings {
public:
  /// Precondition: the document has passed check_document().
  explicit Settings(TomlDocument document);

  bool has(const std::string& path) const { return find_entry(document_, path) != nullptr; }
  double number(const std::string& path) const;
  std::int64_t integer(const std::string& path) const;
  /// True if a key that takes a number or a word has a word.
  bool is_word(const std::string& path) const;
  std::string text(const std::string& path) const;
  std::vector<double> numbers(const std::string& path) const;

  /// True if the document, or a derivation, gives the value: it is not a default.
  bool given(const std::string& path) const { return location(path) != default_location; }

  /// Returns the location of a value or of a table's header, for messages. Precondition: has(path).
  std::string location(const std::string& path) const {
    assert(has(path));
    return find_entry(document_, path)->value_location;
  }

  /// Returns the paths of the tables of a section: none, one, or all of a list.
  std::vector<std::string> tables(const std::string& section) const { return tables_of(document_, section); }

  /// Returns the values in force of a table's keys. Rows are read from the file that they name; rows that affect the
  /// motion are copied into the resolved text, so that a run continues without the file. `scene_name`: as below.
  Parameters parameters(const std::string& table, const std::string& scene_name);

  /// Returns the absolute path of the file that a key names. A path in a scene file is relative to that file, a path on
  /// the command line to the current directory. The resolved text holds the absolute path.
  std::string file_path(const std::string& key, const std::string& scene_name);

  /// Sets a derived value, also in the resolved text; it removes `replaced`, the key from which it was derived.
  void resolve(const std::string& path, DocumentValue value, const std::string& replaced = {});

  /// Returns every key in force as TOML, in the order of the schema. The text reads back to equal settings.
  std::string resolved() const;

  /// Returns a line "path = value" for each key in force that affects the motion, with former names: runs keep their
  /// state hash.
  std::string motion() const;

private:
  /// Returns the paths that a key may have in this document: one per table of its section.
  std::vector<std::string> paths_of(const Key& key) const;
  std::string toml_of(const Key& key, const std::string& path) const;
  std::string table_text(const Section& section, const std::string& table) const;
  NumberRows rows(const Key& key, const std::string& scene_name);
  Parameters::Value parameter(const Key& key, const std::string& scene_name);

  static constexpr const char* default_location = "default";
  TomlDocument document_;
};

/// Returns the law of a registry that a table names, made from the table's values. Throws UsageError if the values do
/// not fit together. Precondition: the registry has the law.
template<class Entry>
auto make_law(const std::vector<Entry>& entries, const std::string& section, Settings& settings,
              const std::string& scene_name) {
  const std::string name = settings.text(section + ".law"), location = settings.location(section + ".law");
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return name == e.name; });
  assert(entry != entries.end());
  const Parameters parameters = settings.parameters(section, scene_name);
  try {
    return entry->make(parameters);
  } catch (const UsageError& fault) {
    fail_at(location, section + ": " + fault.what());
  }
}

} // namespace keeler::config
