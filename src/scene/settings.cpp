#include "settings.hpp"

#include "checks.hpp"

#include <keeler/scene/keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace keeler {
namespace {

// Sections whose defaults are in force even when the file leaves the section out.
bool always_in_force(const std::string& section) {
  return section == "collisions" || section == "collisions.restitution" || section == "output" || section.empty();
}

} // namespace

Settings::Settings(Document document) : document_(std::move(document)) {
  for (const Key& key : scene_keys()) {
    const bool in_force = has(key.section()) || always_in_force(key.section());
    if (!in_force || has(key.path) || key.fallback.empty() || !condition_holds(document_, key.path))
      continue;
    const Value value = parse_override_value(key.fallback, key.path, default_place).front().value;
    document_.push_back({key.path, default_place, default_place, value, false});
  }
}

double Settings::number(const std::string& path) const {
  const Value& value = find_entry(document_, path)->value;
  const auto* integer = std::get_if<std::int64_t>(&value);
  return integer ? static_cast<double>(*integer) : std::get<double>(value);
}

std::int64_t Settings::integer(const std::string& path) const {
  return std::get<std::int64_t>(find_entry(document_, path)->value);
}

std::string Settings::text(const std::string& path) const {
  return std::get<std::string>(find_entry(document_, path)->value);
}

std::vector<double> Settings::numbers(const std::string& path) const {
  return std::get<std::vector<double>>(find_entry(document_, path)->value);
}

std::string Settings::file_path(const std::string& key, const std::string& scene_name) {
  namespace fs = std::filesystem;
  const fs::path base = find_entry(document_, key)->overridden ? fs::path() : fs::path(scene_name).parent_path();
  const std::string path = fs::absolute(base / text(key)).lexically_normal().string();
  resolve(key, path);
  return path;
}

void Settings::resolve(const std::string& path, Value value, const std::string& replaced) {
  document_.erase(std::remove_if(document_.begin(), document_.end(),
                                 [&](const Entry& e) { return e.path == path || e.path == replaced; }),
                  document_.end());
  document_.push_back({path, "derived", "derived", std::move(value), false});
}

std::string Settings::resolved() const {
  std::string out, open;
  for (const Key& key : scene_keys()) {
    const Entry* entry = find_entry(document_, key.path);
    if (!entry)
      continue;
    if (key.section() != open) {
      open = key.section();
      out += fmt::format("\n[{}]\n", open);
    }
    const bool as_double = key.type == KeyType::number; // 3 and 3.0 are one value, and shall be one text
    out += fmt::format("{} = {}\n", key.name(), to_toml(as_double ? Value(number(key.path)) : entry->value));
  }
  return out;
}

} // namespace keeler
