#include <keeler/scene/keys.hpp>

#include "key_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace keeler {

const std::vector<Key>& scene_keys() {
  static const std::vector<Key> keys = make_keys();
  return keys;
}

const std::vector<Section>& scene_sections() {
  static const std::vector<Section> sections = make_sections();
  return sections;
}

std::string declared_path(const std::string& path) {
  std::string declared;
  bool number = false;
  for (const char c : path) {
    number = number || c == '[';
    if (!number)
      declared += c;
    number = number && c != ']';
  }
  return declared;
}

const Key* find_key(const std::string& path) {
  const auto& keys = scene_keys();
  const std::string declared = declared_path(path);
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.path == declared; });
  return found == keys.end() ? nullptr : &*found;
}

const Section* find_section(const std::string& path) {
  const auto& sections = scene_sections();
  const std::string declared = declared_path(path);
  const auto found =
      std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.path == declared; });
  return found == sections.end() ? nullptr : &*found;
}

std::string allowed_words(const Key& key) {
  const std::string range = key.range.words();
  const std::string suffix = range.empty() ? "" : " " + range;
  switch (key.type) {
  case KeyType::text:
    return "a string";
  case KeyType::path:
    return "the path of a file";
  case KeyType::choice:
    return fmt::format("one of \"{}\"", fmt::join(key.choices, "\", \""));
  case KeyType::number:
    return "a number" + suffix +
           (key.choices.empty() ? "" : fmt::format(", or \"{}\"", fmt::join(key.choices, "\", \"")));
  case KeyType::integer:
    return "a whole number" + suffix;
  case KeyType::pair:
    return "two numbers" + suffix;
  case KeyType::triple:
    return "three numbers" + suffix;
  case KeyType::rows:
    return fmt::format("the path of a text file, or rows in place: {}{}", fmt::join(key.columns, ", "), suffix);
  }
  return {};
}

} // namespace keeler
