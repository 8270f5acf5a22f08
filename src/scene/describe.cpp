#include <keeler/scene/keys.hpp>

#include <keeler/scene/quality.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace keeler::scene {
namespace {

using Row = std::array<std::string, 4>; // key, default, unit, meaning

std::string meaning_words(const Key& key) {
  std::string words = fmt::format("{}; {}", key.meaning, config::allowed_words(key));
  for (const std::string& other : key.alternatives)
    words += fmt::format("; or {}", find_key(other)->name());
  if (!key.only_with.key.empty())
    words += fmt::format("; with {}{}", find_key(key.only_with.key)->name(), key.only_with.words());
  return words;
}

std::string default_words(const Key& key, const std::string& code) {
  if (std::find(keys_of_quality.begin(), keys_of_quality.end(), key.path) != keys_of_quality.end())
    return "by " + code + "quality" + code;
  return key.fallback.empty() ? "none" : code + key.fallback + code;
}

std::vector<Row> rows_of_titles(bool markdown) {
  std::vector<Row> rows = {{"key", "default", "unit", "meaning; what it must be"}};
  if (markdown)
    rows.push_back({"---", "---", "---", "---"});
  return rows;
}

Row row_of(const Key& key, bool markdown) {
  const std::string code = markdown ? "`" : "";
  return {code + key.path + code, default_words(key, code), key.unit, meaning_words(key)};
}

std::string table_of(const std::vector<Row>& rows, bool markdown) {
  std::array<std::size_t, 3> widths{};
  for (const Row& row : rows)
    for (std::size_t k = 0; k < widths.size(); ++k)
      widths[k] = std::max(widths[k], row[k].size());

  std::string out;
  for (const Row& row : rows)
    out += markdown ? fmt::format("| {} | {} | {} | {} |\n", row[0], row[1], row[2], row[3])
                    : fmt::format("{:{}}  {:{}}  {:{}}  {}\n", row[0], widths[0], row[1], widths[1], row[2], widths[2],
                                  row[3]);
  return out;
}

// Returns whether the key has this path or this last part of it, or is in a table of this name, such as "friction".
bool is_called(const Key& key, const std::string& name) {
  return !name.empty() && fmt::format(".{}.", key.path).find(fmt::format(".{}.", name)) != std::string::npos;
}

} // namespace

std::string describe_keys(bool markdown) {
  std::vector<Row> rows = rows_of_titles(markdown);
  for (const Key& key : scene_keys())
    rows.push_back(row_of(key, markdown));
  return table_of(rows, markdown);
}

std::string describe_keys_called(const std::string& name) {
  std::vector<Row> rows = rows_of_titles(false);
  const std::size_t titles = rows.size();
  for (const Key& key : scene_keys())
    if (is_called(key, name))
      rows.push_back(row_of(key, false));
  return rows.size() > titles ? table_of(rows, false) : "";
}

} // namespace keeler::scene
