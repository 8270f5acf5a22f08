#include <keeler/config/overrides.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/toml_bounds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::config {
namespace {

bool is_within(const std::string& path, const std::string& table) {
  return path == table || path.rfind(table + ".", 0) == 0 || path.rfind(table + "[", 0) == 0;
}

bool is_dotted_name(const std::string& path) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  };
  return !path.empty() && std::all_of(path.begin(), path.end(), allowed) && path.front() != '.' && path.back() != '.' &&
         path.find("..") == std::string::npos;
}

void erase_within(TomlDocument& document, const std::string& table) {
  document.remove_if([&](const DocumentEntry& entry) { return is_within(entry.path, table); });
}

// Removes the entries at a path that the file gave; keeps entries of other overrides.
void drop_from_file(TomlDocument& document, const std::string& path, const std::string& location,
                    std::vector<std::string>& notices) {
  const DocumentEntry* entry = find_entry(document, path);
  if (!entry || entry->overridden)
    return;
  notices.push_back(fmt::format("{} of the scene is ignored: {} replaces it", path, location));
  erase_within(document, path);
}

void drop_contradictions(TomlDocument& document, const DocumentEntry& by, std::vector<std::string>& notices) {
  const Schema& schema = document.schema();
  const Key* overriding = schema.find_key(by.path);
  if (!overriding)
    return;
  for (const std::string& other : overriding->alternatives)
    drop_from_file(document, other, by.value_location, notices);
  for (const Section& section : schema.sections())
    if (section.replaced_by == by.path)
      drop_from_file(document, section.path, by.value_location, notices);
  for (const Key& key : schema.keys()) {
    const std::string& condition = key.only_with.key;
    const auto& others = overriding->alternatives;
    const bool was_alternative = std::find(others.begin(), others.end(), condition) != others.end();
    const std::string* value = std::get_if<std::string>(&by.value);
    if (was_alternative || (condition == by.path && value && !key.only_with.allows(*value)))
      drop_from_file(document, key.path, by.value_location, notices);
  }
}

void add_parent_tables(TomlDocument& document, const std::string& path, const std::string& location) {
  if (static_cast<std::size_t>(std::count(path.begin(), path.end(), '.')) >= files::max_toml_depth)
    fail_at(location, fmt::format("unknown key (it has more than {} parts); "
                                  "\"keeler check --defaults\" lists every key",
                                  files::max_toml_depth));
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1))
    if (!find_entry(document, path.substr(0, dot)))
      document.add({path.substr(0, dot), location, location, TomlTable{}, true});
}

// The first entry is what the override names, the others are within it.
void apply(TomlDocument& document, const std::vector<DocumentEntry>& entries, const std::string& location,
           std::vector<std::string>& notices) {
  assert(!entries.empty());
  const std::string& path = entries.front().path;
  erase_within(document, path);
  add_parent_tables(document, path, location);
  for (const DocumentEntry& entry : entries) {
    drop_contradictions(document, entry, notices);
    document.add(entry);
  }
}

// Returns what messages show of an override, abridged: each of its entries holds a copy.
std::string location_of(const std::string& text) {
  constexpr std::size_t longest = 200;
  return "--set " + (text.size() <= longest ? text : text.substr(0, longest) + " [...]");
}

Override from_command_line(const std::string& text) {
  const std::string location = location_of(text);
  const std::size_t equals = text.find('=');
  const std::string path = text.substr(0, equals);
  if (equals == std::string::npos || !is_dotted_name(path))
    throw UsageError(location + ": not an override (it needs a key and a value); write --set table.key=value");
  return {path, text.substr(equals + 1), location, location};
}

} // namespace

void apply_text(TomlDocument& document, const std::string& path, const std::string& text, const std::string& location,
                std::vector<std::string>& notices) {
  apply(document, {{path, location, location, text, true}}, location, notices);
}

void apply_override(TomlDocument& document, const Override& override, std::vector<std::string>& notices) {
  apply(document,
        parse_override_value(override.value, override.key, override.key_location, override.value_location,
                             document.schema()),
        override.value_location, notices);
}

void apply_overrides(TomlDocument& document, const std::vector<std::string>& overrides,
                     std::vector<std::string>& notices) {
  constexpr std::size_t max_overrides = 1000; // each is checked against all of the document
  if (overrides.size() > max_overrides)
    throw UsageError(fmt::format("{} overrides are too many (at most {}); write their values into the scene",
                                 overrides.size(), max_overrides));
  for (const std::string& text : overrides)
    apply_override(document, from_command_line(text), notices);
}

} // namespace keeler::config
