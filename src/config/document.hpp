// A TOML text as a flat list of entries, each with its location for messages. It hides the TOML library.
#pragma once

#include <keeler/config/schema.hpp>
#include <keeler/core/key.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

namespace keeler::config {

struct TomlTable {};

/// A list of tables, [[path]]. Table n (from 1) is a separate entry, path[n].
struct TomlTableList {
  std::size_t count = 0;
};

/// A TOML value of a type that no key takes; `what` names it in messages.
struct Unusable {
  std::string what;
};

using DocumentValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>, NumberRows, TomlTable,
                                   TomlTableList, Unusable>;

/// A key or a table header. Names that are not plain keep their quotes in the path: "a.b" is not key b of table a.
struct DocumentEntry {
  std::string path;           ///< "particles.sizes.radius"
  std::string key_location;   ///< of the name: "scene.toml:3:1", or "--set a.b=value"
  std::string value_location; ///< of the value
  DocumentValue value;
  bool overridden = false; ///< an override gave it
  std::string former{};    ///< the path as it was written, if that has a former name
};

/// Entries in the order of the file, overrides last. No path occurs twice. Tables that the schema lacks are not
/// expanded: an unknown table is an entry without keys.
class TomlDocument {
public:
  /// Constructs an empty document. Precondition: the schema outlives it.
  explicit TomlDocument(const Schema& schema) : schema_(&schema) {}

  const Schema& schema() const { return *schema_; }

  std::vector<DocumentEntry>::const_iterator begin() const { return entries_.begin(); }
  std::vector<DocumentEntry>::const_iterator end() const { return entries_.end(); }
  const DocumentEntry& front() const { return entries_.front(); }

  /// Returns the entry of a path, nullptr if there is none.
  const DocumentEntry* find(const std::string& path) const;
  /// Adds an entry at the end. Precondition: no entry has its path.
  void add(DocumentEntry entry);
  /// Removes the entries for which `gone` is true.
  template<class Gone> void remove_if(const Gone& gone) {
    if (std::erase_if(entries_, gone) > 0)
      number();
  }

private:
  void number();

  const Schema* schema_;
  std::vector<DocumentEntry> entries_;
  std::unordered_map<std::string, std::size_t> positions_; // by path
};

/// Returns the paths of the document's tables of a section: none, one, or all of a list.
std::vector<std::string> tables_of(const TomlDocument& document, const std::string& section);

inline const DocumentEntry* find_entry(const TomlDocument& document, const std::string& path) {
  return document.find(path);
}

/// Parses a text; messages call it `name`. Paths have the present names. Throws UsageError if the text is not TOML, or
/// gives a key by its present and its former name.
TomlDocument parse_document(const std::string& text, const std::string& name, const Schema& schema);

/// Parses the value of an override: TOML, or else the text as a string (as a number, if the key takes one and the text
/// spells one). All entries are marked as overridden and have the given locations; there is at least one. Throws
/// UsageError if the value nests too deep.
std::vector<DocumentEntry> parse_override_value(const std::string& text, const std::string& path,
                                                const std::string& key_location, const std::string& value_location,
                                                const Schema& schema);

/// Returns a line for each former name in the document, with the location of its first use.
std::vector<std::string> former_name_notices(const TomlDocument& document);

/// Throws UsageError "location: message".
[[noreturn]] void fail_at(const std::string& location, const std::string& message);

/// Returns the type of a value in words: "a string", "a table", …
std::string kind_words(const DocumentValue& value);

/// Returns the value as TOML on one line; tables and unusable values in words.
std::string to_toml(const DocumentValue& value);

} // namespace keeler::config
