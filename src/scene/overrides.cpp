#include "overrides.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/toml_bounds.hpp>
#include <keeler/scene/keys.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {
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

void erase_within(SceneDocument& document, const std::string& table) {
  document.remove_if([&](const DocumentEntry& entry) { return is_within(entry.path, table); });
}

// Drops what the file (never another override) says at a path.
void drop_from_file(SceneDocument& document, const std::string& path, const std::string& place,
                    std::vector<std::string>& notices) {
  const DocumentEntry* entry = find_entry(document, path);
  if (!entry || entry->overridden)
    return;
  notices.push_back(fmt::format("{} of the scene is dropped: {} takes its place", path, place));
  erase_within(document, path);
}

void drop_contradictions(SceneDocument& document, const DocumentEntry& by, std::vector<std::string>& notices) {
  const Key* overriding = find_key(by.path);
  if (!overriding)
    return;
  for (const std::string& other : overriding->alternatives)
    drop_from_file(document, other, by.value_place, notices);
  for (const Section& section : scene_sections())
    if (section.replaced_by == by.path)
      drop_from_file(document, section.path, by.value_place, notices);
  for (const Key& key : scene_keys()) {
    const std::string& condition = key.only_with.key;
    const auto& others = overriding->alternatives;
    const bool was_alternative = std::find(others.begin(), others.end(), condition) != others.end();
    const std::string* value = std::get_if<std::string>(&by.value);
    if (was_alternative || (condition == by.path && value && !key.only_with.allows(*value)))
      drop_from_file(document, key.path, by.value_place, notices);
  }
}

void add_parent_tables(SceneDocument& document, const std::string& path, const std::string& place) {
  if (static_cast<std::size_t>(std::count(path.begin(), path.end(), '.')) >= max_toml_depth)
    fail_at(place, fmt::format("unknown key (it has more than {} parts, and no key has more than a few); "
                               "\"keeler check --defaults\" lists every key",
                               max_toml_depth));
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1))
    if (!find_entry(document, path.substr(0, dot)))
      document.add({path.substr(0, dot), place, place, Table{}, true});
}

void apply(SceneDocument& document, const std::string& path, const SceneDocument& entries, const std::string& place,
           std::vector<std::string>& notices) {
  erase_within(document, path);
  add_parent_tables(document, path, place);
  for (const DocumentEntry& entry : entries) {
    drop_contradictions(document, entry, notices);
    document.add(entry);
  }
}

// What messages show of an override. Each of its entries has it, so a long one is cut.
std::string place_of(const std::string& text) {
  constexpr std::size_t longest = 200;
  return "--set " + (text.size() <= longest ? text : text.substr(0, longest) + " [...]");
}

Override from_command_line(const std::string& text) {
  const std::string place = place_of(text);
  const std::size_t equals = text.find('=');
  const std::string path = text.substr(0, equals);
  if (equals == std::string::npos || !is_dotted_name(path))
    throw UsageError(place + ": not an override (it needs a key and a value); write --set table.key=value");
  return {path, text.substr(equals + 1), place, place};
}

} // namespace

void apply_start(SceneDocument& document, const std::string& snapshot, std::vector<std::string>& notices) {
  const std::string path = "start.from", place = "--from " + snapshot;
  apply(document, path, {{path, place, place, snapshot, true}}, place, notices);
}

void apply_table(SceneDocument& document) {
  if (const DocumentEntry* entry = find_entry(document, "start.from"))
    fail_at(entry->value_place, "start.from cannot stand beside a table of particles (either is the start); remove one "
                                "of the two");
  if (const DocumentEntry* entry = find_entry(document, "box.size_in_wavelengths"))
    fail_at(entry->value_place, "box.size_in_wavelengths cannot stand beside a table of particles (the wavelength "
                                "follows from a surface density that the scene asks for); give box.size");
  document.remove_if([](const DocumentEntry& entry) {
    return is_within(entry.path, "particles") && entry.path != "particles" && entry.path != "particles.density" &&
           (find_key(entry.path) || find_section(entry.path));
  });
  std::vector<std::string> none;
  const auto set = [&](const char* key, const char* value) { apply_override(document, {key, value, key, key}, none); };
  set("particles.count", "1");
  set("particles.sizes", "{ law = \"equal\", radius = 1e-6 }");
  if (!find_entry(document, "particles.density"))
    set("particles.density", "1000.0");
}

void apply_override(SceneDocument& document, const Override& by, std::vector<std::string>& notices) {
  apply(document, by.key, parse_override_value(by.value, by.key, by.key_place, by.value_place), by.value_place,
        notices);
}

void apply_overrides(SceneDocument& document, const std::vector<std::string>& overrides,
                     std::vector<std::string>& notices) {
  constexpr std::size_t most = 1000; // each is held against all that the scene has
  if (overrides.size() > most)
    throw UsageError(fmt::format("{} overrides are too many (a scene takes {} at most, and has fewer keys); write what "
                                 "they give into the scene",
                                 overrides.size(), most));
  for (const std::string& text : overrides)
    apply_override(document, from_command_line(text), notices);
}

} // namespace keeler
