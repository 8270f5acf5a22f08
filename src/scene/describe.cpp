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

std::vector<Row> make_rows(bool markdown) {
  std::vector<Row> rows = {{"key", "default", "unit", "meaning; what it must be"}};
  if (markdown)
    rows.push_back({"---", "---", "---", "---"});
  for (const Key& key : scene_keys()) {
    const std::string code = markdown ? "`" : "";
    rows.push_back({code + key.path + code, default_words(key, code), key.unit, meaning_words(key)});
  }
  return rows;
}

} // namespace

std::string describe_keys(bool markdown) {
  const std::vector<Row> rows = make_rows(markdown);
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

} // namespace keeler::scene
