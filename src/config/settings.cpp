#include <keeler/config/settings.hpp>

#include <keeler/config/checks.hpp>
#include <keeler/core/printable.hpp>
#include <keeler/files/input.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <span>

namespace keeler::config {
namespace {

// Throws UsageError if a row of a file that a key names does not fit the key.
void check_row(const Key& key, std::span<const double> row, const std::string& location) {
  assert(!key.columns.empty());
  const bool right = row.size() == key.columns.size() && std::all_of(row.begin(), row.end(), [&](double number) {
                       return std::isfinite(number) && key.range.contains(number);
                     });
  const bool words = std::any_of(row.begin(), row.end(), [](double number) { return std::isnan(number); });
  if (!right)
    fail_at(location,
            fmt::format("the line {}, but must be {}{} ({}); correct this line",
                        words ? "has a word that is not a number" : fmt::format("is {}", fmt::join(row, " ")),
                        key.columns.size() == 1 ? "a number" : fmt::format("{} numbers", key.columns.size()),
                        key.range.words().empty() ? "" : " " + key.range.words(), fmt::join(key.columns, ", ")));
}

NumberRows read_rows(const std::string& path, const Key& key, const std::string& location) {
  NumberRows rows;
  files::for_each_row(files::read_input(path, location), [&](int line, std::span<const double> row) {
    check_row(key, row, fmt::format("{}:{}:1", path, line));
    rows.emplace_back(row.begin(), row.end());
  });
  if (rows.empty())
    fail_at(location, fmt::format("{} has no numbers (it is empty, or has only comments); write {} on each line", path,
                                  fmt::join(key.columns, " and ")));
  return rows;
}

} // namespace

Settings::Settings(TomlDocument document) : document_(std::move(document)) {
  for (const Key& key : document_.schema().keys())
    for (const std::string& path : paths_of(key)) {
      if (has(path) || key.fallback.empty() || !condition_holds(document_, path))
        continue;
      const DocumentValue value =
          parse_override_value(key.fallback, path, default_location, default_location, document_.schema())
              .front()
              .value;
      document_.add({path, default_location, default_location, value, false});
    }
}

std::vector<std::string> Settings::paths_of(const Key& key) const {
  const std::string section = key.section();
  if (section.empty() || document_.schema().find_section(section)->defaults_if_absent)
    return {key.path};
  std::vector<std::string> paths = tables(section);
  for (std::string& path : paths)
    path += "." + key.name();
  return paths;
}

double Settings::number(const std::string& path) const {
  assert(has(path));
  const DocumentValue& value = find_entry(document_, path)->value;
  const auto* integer = std::get_if<std::int64_t>(&value);
  return integer ? static_cast<double>(*integer) : std::get<double>(value);
}

std::int64_t Settings::integer(const std::string& path) const {
  assert(has(path));
  return std::get<std::int64_t>(find_entry(document_, path)->value);
}

bool Settings::is_word(const std::string& path) const {
  assert(has(path));
  return std::holds_alternative<std::string>(find_entry(document_, path)->value);
}

std::string Settings::text(const std::string& path) const {
  assert(has(path));
  return std::get<std::string>(find_entry(document_, path)->value);
}

std::vector<double> Settings::numbers(const std::string& path) const {
  assert(has(path));
  return std::get<std::vector<double>>(find_entry(document_, path)->value);
}

std::string Settings::file_path(const std::string& key, const std::string& scene_name) {
  assert(has(key));
  namespace fs = std::filesystem;
  const fs::path base = find_entry(document_, key)->overridden ? fs::path() : fs::path(scene_name).parent_path();
  const std::string path = fs::absolute(base / text(key)).lexically_normal().string();
  resolve(key, path);
  return path;
}

void Settings::resolve(const std::string& path, DocumentValue value, const std::string& replaced) {
  document_.remove_if([&](const DocumentEntry& e) { return e.path == path || e.path == replaced; });
  document_.add({path, "derived", "derived", std::move(value), false});
}

NumberRows Settings::rows(const Key& key, const std::string& scene_name) {
  assert(key.type == KeyType::rows && has(key.path));
  const DocumentValue& value = find_entry(document_, key.path)->value;
  if (const auto* given = std::get_if<NumberRows>(&value))
    return *given;
  if (std::holds_alternative<std::vector<double>>(value)) // []
    return {};
  const std::string location = this->location(key.path), path = file_path(key.path, scene_name);
  NumberRows rows = read_rows(path, key, location);
  if (key.effect == KeyEffect::motion)
    resolve(key.path, rows);
  return rows;
}

Parameters::Value Settings::parameter(const Key& key, const std::string& scene_name) {
  switch (key.type) {
  case KeyType::number:
    return number(key.path);
  case KeyType::integer:
    return integer(key.path);
  case KeyType::pair:
  case KeyType::triple:
    return numbers(key.path);
  case KeyType::rows:
    return rows(key, scene_name);
  case KeyType::path:
    return file_path(key.path, scene_name);
  case KeyType::text:
  case KeyType::choice:
    break;
  }
  return text(key.path);
}

Parameters Settings::parameters(const std::string& table, const std::string& scene_name) {
  Parameters parameters;
  const std::string section = declared_path(table);
  for (const Key& declared : document_.schema().keys()) {
    if (declared.section() != section)
      continue;
    Key key = declared;
    const std::string name = key.name();
    key.path = table + "." + name;
    if (has(key.path))
      parameters.set(name, parameter(key, scene_name));
  }
  return parameters;
}

std::string Settings::toml_of(const Key& key, const std::string& path) const {
  // 3 and 3.0 are equal values and get equal texts
  const bool as_double = key.type == KeyType::number && !is_word(path);
  const DocumentEntry& entry = *find_entry(document_, path);
  // A command line or the name of a folder may not be UTF-8, but a scene file must be.
  if (const auto* text = std::get_if<std::string>(&entry.value); text && !is_utf8(*text))
    fail_at(entry.value_location,
            fmt::format("{} is '{}', which is not UTF-8, and a scene must be; {}", path, *text,
                        key.path == "title" ? "write it in UTF-8" : "rename the file or the folder"));
  return to_toml(as_double ? DocumentValue(number(path)) : entry.value);
}

std::string Settings::motion() const {
  std::string out;
  for (const Key& key : document_.schema().keys())
    for (const std::string& path : paths_of(key))
      if (key.effect == KeyEffect::motion && has(path))
        if (const std::string value = toml_of(key, path); key.unhashed.empty() || value != key.unhashed)
          out +=
              fmt::format("{} = {}\n", key.former_name.empty() ? path : key.section() + "." + key.former_name, value);
  return out;
}

std::string Settings::table_text(const Section& section, const std::string& table) const {
  std::string out;
  for (const Key& key : document_.schema().keys())
    if (const std::string path = table + "." + key.name(); key.section() == section.path && has(path))
      out += fmt::format("{} = {}\n", key.name(), toml_of(key, path));
  return out.empty() ? out : fmt::format("\n{}\n{}", section.header(), out);
}

std::string Settings::resolved() const {
  std::string out, open;
  for (const Key& key : document_.schema().keys()) {
    if (key.section().empty() && has(key.path))
      out += fmt::format("{} = {}\n", key.name(), toml_of(key, key.path));
    if (key.section() == open)
      continue;
    open = key.section();
    const Section& section = *document_.schema().find_section(open);
    if (!section.repeated)
      out += table_text(section, open);
    for (const std::string& table : section.repeated ? tables(open) : std::vector<std::string>())
      out += table_text(section, table);
  }
  return out;
}

} // namespace keeler::config
