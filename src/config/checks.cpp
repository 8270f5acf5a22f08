#include <keeler/config/checks.hpp>

#include "suggest.hpp"

#include <keeler/core/suggest.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::config {
namespace {

std::string meaning_of(const Key& key) {
  return key.unit.empty() || key.unit == "1"
             ? key.meaning
             : fmt::format("{}{}in {}", key.meaning, key.meaning.empty() ? "" : ", ", key.unit);
}

std::string sample_of(const Key& key) {
  return fmt::format("{} = {}", key.name(), key.fallback.empty() ? key.example : key.fallback);
}

[[noreturn]] void fail_unknown(const DocumentEntry& entry, const Schema& schema) {
  const std::string near = suggest_path(entry.path, schema);
  if (entry.path == "scene")
    fail_at(entry.key_location,
            "unknown key scene (the grid of a sweep has it, a scene has not); for a grid use \"keeler sweep\"");
  const std::string what = std::holds_alternative<TomlTable>(entry.value) ? "table" : "key";
  fail_at(entry.key_location, fmt::format("unknown {} {} (no scene has it); {}", what, entry.path,
                                          near.empty() ? "\"keeler check --defaults\" lists every key"
                                                       : fmt::format("did you mean \"{}\"?", near)));
}

bool fits_type(const Key& key, const DocumentValue& value) {
  switch (key.type) {
  case KeyType::text:
  case KeyType::choice:
  case KeyType::path:
    return std::holds_alternative<std::string>(value);
  case KeyType::number:
    return std::holds_alternative<double>(value) || std::holds_alternative<std::int64_t>(value) ||
           (!key.choices.empty() && std::holds_alternative<std::string>(value));
  case KeyType::integer:
    return std::holds_alternative<std::int64_t>(value);
  case KeyType::pair:
  case KeyType::triple: {
    const auto* list = std::get_if<std::vector<double>>(&value);
    return list && list->size() == (key.type == KeyType::pair ? 2 : 3);
  }
  case KeyType::rows: {
    const auto* rows = std::get_if<NumberRows>(&value);
    const auto* list = std::get_if<std::vector<double>>(&value);
    const bool none = list && list->empty() && !key.fallback.empty(); // [] is allowed where the key has a default
    return none || std::holds_alternative<std::string>(value) ||
           (rows && std::all_of(rows->begin(), rows->end(),
                                [&](const std::vector<double>& row) { return row.size() == key.columns.size(); }));
  }
  }
  return false;
}

std::vector<double> numbers_in(const DocumentValue& value) {
  if (const auto* number = std::get_if<double>(&value))
    return {*number};
  if (const auto* integer = std::get_if<std::int64_t>(&value))
    return {static_cast<double>(*integer)};
  std::vector<double> numbers;
  if (const auto* rows = std::get_if<NumberRows>(&value))
    for (const std::vector<double>& row : *rows)
      numbers.insert(numbers.end(), row.begin(), row.end());
  const auto* list = std::get_if<std::vector<double>>(&value);
  return list ? *list : numbers;
}

bool fits_value(const Key& key, const DocumentValue& value) {
  const std::vector<double> numbers = numbers_in(value);
  if (!std::all_of(numbers.begin(), numbers.end(), [&](double n) { return std::isfinite(n) && key.range.contains(n); }))
    return false;
  const auto* text = std::get_if<std::string>(&value);
  if (key.type == KeyType::path || (key.type == KeyType::rows && text))
    return !text->empty();
  return !text || key.choices.empty() || std::find(key.choices.begin(), key.choices.end(), *text) != key.choices.end();
}

void check_value(const Key& key, const DocumentEntry& entry) {
  const bool right_type = fits_type(key, entry.value);
  if (right_type && fits_value(key, entry.value))
    return;
  const auto* const number = std::get_if<double>(&entry.value);
  const bool has_fraction = number && std::isfinite(*number) && *number != std::trunc(*number);
  const bool is_too_large = key.type == KeyType::integer && number && !has_fraction;
  const std::string is = right_type || is_too_large ? to_toml(entry.value) : kind_words(entry.value);
  std::string advice = "write for example " + sample_of(key);
  if (const auto* word = std::get_if<std::string>(&entry.value); word && !key.choices.empty())
    if (const std::string near = closest(*word, key.choices); !near.empty())
      advice = fmt::format("did you mean \"{}\"?", near);
  fail_at(entry.value_location, fmt::format("{} is {}, but must be {} ({}); {}", entry.path, is, allowed_words(key),
                                            meaning_of(key), advice));
}

void check_entry(const DocumentEntry& entry, const Schema& schema) {
  if (const Key* key = schema.find_key(entry.path))
    return check_value(*key, entry);
  const Section* const section = schema.find_section(entry.path);
  if (!section)
    fail_unknown(entry, schema);
  const bool list = section->repeated && entry.path == section->path;
  if (list ? !std::holds_alternative<TomlTableList>(entry.value) : !std::holds_alternative<TomlTable>(entry.value))
    fail_at(entry.value_location,
            fmt::format("{} is {}, but must be a {} ({}); write {} and its keys below", entry.path,
                        kind_words(entry.value), list ? "list of tables" : "table",
                        list ? "there may be several" : "it holds several keys", section->header()));
  if (const auto* const tables = std::get_if<TomlTableList>(&entry.value); tables && tables->count > section->max_count)
    fail_at(entry.value_location,
            fmt::format("{} tables {} are too many (at most {}: each is checked against all others); remove some",
                        tables->count, section->header(), section->max_count));
}

// Returns the path of the key `other` in the table of `path`.
std::string beside(const std::string& path, const std::string& other) {
  assert(!path.empty() && !other.empty());
  return declared_path(path) == path ? other : Key{.path = path}.section() + "." + Key{.path = other}.name();
}

void check_contradictions(const TomlDocument& document) {
  for (const DocumentEntry& entry : document) {
    if (const Section* section = document.schema().find_section(entry.path))
      if (!section->replaced_by.empty() && find_entry(document, section->replaced_by))
        fail_at(entry.key_location, fmt::format("{} cannot be combined with {} (the start file holds the box and its "
                                                "particles); remove one of the two",
                                                section->header(), section->replaced_by));
    const Key* key = document.schema().find_key(entry.path);
    if (!key)
      continue;
    for (const std::string& other : key->alternatives)
      if (const DocumentEntry* earlier = find_entry(document, beside(entry.path, other)); earlier && earlier < &entry)
        fail_at(entry.key_location,
                fmt::format("{} cannot be combined with {} (each determines the other); keep one of the two",
                            entry.path, earlier->path));
    if (!condition_holds(document, entry.path)) {
      const KeyCondition& needs = key->only_with;
      fail_at(entry.key_location, fmt::format("{0} does not apply here (it needs {1}{2}); remove it or give {1}{2}",
                                              entry.path, needs.key, needs.words()));
    }
  }
}

// Fails at `place` if a needed key is absent. `path`: that of the key, or in one table of a list.
void check_key_present(const TomlDocument& document, const Key& key, const std::string& path,
                       const std::string& location) {
  const auto given = [&](const std::string& other) { return find_entry(document, beside(path, other)) != nullptr; };
  if (given(path) || !key.fallback.empty() || !condition_holds(document, key.path) ||
      std::any_of(key.alternatives.begin(), key.alternatives.end(), given))
    return;
  std::string other_ways;
  for (const std::string& other : key.alternatives)
    other_ways += " or " + document.schema().find_key(other)->name();
  fail_at(location,
          fmt::format("{} is missing ({}); add for example {}{}", path, meaning_of(key), sample_of(key), other_ways));
}

void check_complete(const TomlDocument& document, const std::string& name) {
  for (const Section& section : document.schema().sections()) {
    const DocumentEntry* entry = find_entry(document, section.path);
    if (!entry && (!section.needed || (!section.replaced_by.empty() && find_entry(document, section.replaced_by))))
      continue;
    if (!entry) {
      const DocumentEntry* parent = find_entry(document, Key{.path = section.path}.section());
      fail_at(parent ? parent->key_location : name + ":1:1",
              fmt::format("[{0}] is missing ({1}); add a table [{0}]", section.path, section.meaning));
    }
    for (const std::string& table : tables_of(document, section.path))
      for (const Key& key : document.schema().keys())
        if (key.section() == section.path)
          check_key_present(document, key, table + "." + key.name(), find_entry(document, table)->key_location);
  }
}

} // namespace

bool condition_holds(const TomlDocument& document, const std::string& path) {
  const Schema& schema = document.schema();
  assert(schema.find_key(path));
  const Key& key = *schema.find_key(path);
  if (key.only_with.key.empty())
    return true;
  const DocumentEntry* entry = find_entry(document, key.only_with.key);
  if (key.only_with.values.empty())
    return entry != nullptr;
  const DocumentValue value =
      entry ? entry->value
            : parse_override_value(schema.find_key(key.only_with.key)->fallback, "", "", "", schema).front().value;
  const auto* word = std::get_if<std::string>(&value);
  return word && key.only_with.allows(*word);
}

void check_document(const TomlDocument& document, const std::string& name) {
  for (const DocumentEntry& entry : document)
    check_entry(entry, document.schema());
  check_contradictions(document);
  check_complete(document, name);
}

} // namespace keeler::config
