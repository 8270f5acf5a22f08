// The values in force: what a checked document says, and defaults for the rest.
#pragma once

#include "document.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/key.hpp>
#include <keeler/scene/keys.hpp>

#include <algorithm>
#include <cstdint>
#include <string>

namespace keeler {

class Settings {
public:
  /// The document has passed check_document.
  explicit Settings(SceneDocument document);

  bool has(const std::string& path) const { return find_entry(document_, path) != nullptr; }
  double number(const std::string& path) const;
  std::int64_t integer(const std::string& path) const;
  /// Whether a key that is a number or a word is a word.
  bool is_word(const std::string& path) const;
  std::string text(const std::string& path) const;
  std::vector<double> numbers(const std::string& path) const;

  /// Whether the scene says it: it is no default.
  bool given(const std::string& path) const { return place(path) != default_place; }

  /// Where the value (or a table's header) stands, for messages.
  std::string place(const std::string& path) const { return find_entry(document_, path)->value_place; }

  /// The paths of the tables that the scene has of a section: none, its own, or those of its list.
  std::vector<std::string> tables(const std::string& section) const { return tables_of(document_, section); }

  /// The values in force of a table's keys. Rows are read from the file that they name; those that have a say in the
  /// motion then stand in the resolved scene themselves, so that a run goes on without the file. `scene_name`: as
  /// below.
  Parameters parameters(const std::string& table, const std::string& scene_name);

  /// The absolute path of the file that a key names: what a scene file says is relative to it, what the command line
  /// says to the current directory. The resolved scene holds the absolute path.
  std::string file_path(const std::string& key, const std::string& scene_name);

  /// Fills in what was derived, so that the resolved scene has it; `replaced` is the key that led to it.
  void resolve(const std::string& path, DocumentValue value, const std::string& replaced = {});

  /// The scene as TOML: every key in force, in the order of the key table. It reads back to the same scene.
  std::string resolved() const;

  /// A line "path = value" for each key in force that has a say in the motion.
  std::string motion() const;

private:
  /// Where a key may stand in this scene: once in each of its section's tables.
  std::vector<std::string> paths_of(const Key& key) const;
  std::string toml_of(const Key& key, const std::string& path) const;
  std::string table_text(const Section& section, const std::string& table) const;
  NumberRows rows(const Key& key, const std::string& scene_name);
  Parameters::Value parameter(const Key& key, const std::string& scene_name);

  static constexpr const char* default_place = "default";
  SceneDocument document_;
};

/// The law of a registry that a table of the scene names, made from the table's values.
template<class Entry>
auto make_law(const std::vector<Entry>& entries, const std::string& section, Settings& settings,
              const std::string& scene_name) {
  const std::string name = settings.text(section + ".law"), place = settings.place(section + ".law");
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return name == e.name; });
  const Parameters parameters = settings.parameters(section, scene_name);
  try {
    return entry->make(parameters);
  } catch (const UsageError& fault) {
    fail_at(place, section + ": " + fault.what());
  }
}

} // namespace keeler
