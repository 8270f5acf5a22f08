// A TOML text as a flat list of entries, each with the place that messages name. No other file sees the TOML library.
#pragma once

#include <keeler/core/key.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

namespace keeler {

struct Table {};

/// A list of tables, [[path]]; table n of it is an entry path[n] of its own, from 1.
struct TableList {
  std::size_t count = 0;
};

/// A TOML value that no key takes; `what` names it in messages.
struct Unusable {
  std::string what;
};

using DocumentValue =
    std::variant<bool, std::int64_t, double, std::string, std::vector<double>, NumberRows, Table, TableList, Unusable>;

/// One key or table header. Names that are not plain keep their quotes in the path, so "a.b" is never a table a.
struct DocumentEntry {
  std::string path;        ///< "particles.sizes.radius"
  std::string key_place;   ///< where the name stands: "scene.toml:3:1", or "--set a.b=value"
  std::string value_place; ///< where the value stands
  DocumentValue value;
  bool overridden = false; ///< given by an override
};

/// In the order of the file, overrides last. No path occurs twice. What no scene has is not looked into: an unknown
/// table is an entry, and its keys are none.
class SceneDocument {
public:
  SceneDocument() = default;
  SceneDocument(std::initializer_list<DocumentEntry> entries) {
    for (const DocumentEntry& entry : entries)
      add(entry);
  }

  std::vector<DocumentEntry>::const_iterator begin() const { return entries_.begin(); }
  std::vector<DocumentEntry>::const_iterator end() const { return entries_.end(); }
  const DocumentEntry& front() const { return entries_.front(); }

  /// Returns null where no entry has the path.
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

  std::vector<DocumentEntry> entries_;
  std::unordered_map<std::string, std::size_t> positions_; // by path
};

/// The paths of the tables that a document has of a section: none, its own, or those of its list.
std::vector<std::string> tables_of(const SceneDocument& document, const std::string& section);

inline const DocumentEntry* find_entry(const SceneDocument& document, const std::string& path) {
  return document.find(path);
}

/// Throws UsageError where the text is not TOML; `name` stands for the file.
SceneDocument parse_document(const std::string& text, const std::string& name);

/// Bytes of a text, the end not included.
struct TextRange {
  std::size_t begin = 0, end = 0;
};

/// Where a key's value stands in a TOML text; of a table its braces, or its header. None: the key is not there. Throws
/// as parse_document().
std::optional<TextRange> range_in(const std::string& text, const std::string& name, const std::string& path);

/// The value of an override: TOML, or else the text itself as a string (of a key that takes a number as that number,
/// where the text reads as one). All entries are overridden and have the places. Throws UsageError where the value
/// nests too deep.
SceneDocument parse_override_value(const std::string& text, const std::string& path, const std::string& key_place,
                                   const std::string& value_place);

/// Throws UsageError "place: message".
[[noreturn]] void fail_at(const std::string& place, const std::string& message);

/// "a string", "a table", …
std::string kind_words(const DocumentValue& value);

/// The value as TOML on one line (tables and unusable values in words).
std::string to_toml(const DocumentValue& value);

} // namespace keeler
