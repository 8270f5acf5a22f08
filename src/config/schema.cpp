#include <keeler/config/schema.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <set>
#include <utility>

namespace keeler::config {
namespace {

// Returns the entry with the declared path, nullptr if there is none.
template<class Entry> const Entry* declared(const std::vector<Entry>& entries, const std::string& path) {
  const std::string wanted = declared_path(path);
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.path == wanted; });
  return found == entries.end() ? nullptr : &*found;
}

template<class Entry> [[maybe_unused]] bool has_unique_paths(const std::vector<Entry>& entries) {
  std::set<std::string> paths;
  return std::all_of(entries.begin(), entries.end(), [&](const Entry& e) { return paths.insert(e.path).second; });
}

} // namespace

Schema::Schema(std::vector<Key> keys, std::vector<Section> sections)
    : keys_(std::move(keys)), sections_(std::move(sections)) {
  assert(has_unique_paths(keys_));
  assert(has_unique_paths(sections_));
  assert(std::all_of(keys_.begin(), keys_.end(),
                     [&](const Key& key) { return key.section().empty() || find_section(key.section()); }));
  assert(std::all_of(keys_.begin(), keys_.end(), [&](const Key& key) {
    return std::all_of(key.alternatives.begin(), key.alternatives.end(), [&](const auto& k) { return find_key(k); });
  }));
  assert(std::all_of(keys_.begin(), keys_.end(), [&](const Key& key) { return current_path(key.path) == key.path; }));
}

std::string Schema::current_path(std::string path) const {
  for (const Section& section : sections_)
    if (const std::string& former = section.former_path; !former.empty() && (path + ".").starts_with(former + "."))
      path.replace(0, former.size(), section.path);
  const std::string wanted = declared_path(path);
  for (const Key& key : keys_)
    if (!key.former_name.empty() && wanted == key.section() + "." + key.former_name)
      path.replace(path.rfind('.') + 1, std::string::npos, key.name());
  return path;
}

const Key* Schema::find_key(const std::string& path) const {
  const Key* const key = declared(keys_, path);
  return key ? key : declared(keys_, current_path(path));
}

const Section* Schema::find_section(const std::string& path) const {
  return declared(sections_, path);
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

} // namespace keeler::config
