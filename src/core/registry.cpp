#include <keeler/core/registry.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <set>

namespace keeler {
namespace {

bool is_plain_name(std::string_view name) {
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == name.npos;
}

bool is_complete(const Key& key) {
  return (!key.fallback.empty() || !key.example.empty()) && key.alternatives.empty() &&
         (key.type != KeyType::choice || !key.choices.empty()) && (key.type != KeyType::rows || !key.columns.empty());
}

} // namespace

void require_registrable_name(const std::string& what, const char* name) {
  if (!name || !is_plain_name(name))
    throw UsageError(fmt::format("a {} cannot be called '{}' (a name has small letters, digits and '_', and begins "
                                 "with a letter); rename it",
                                 what, name ? name : ""));
}

void require_complete_keys(const std::string& what, const std::string& name, const std::vector<Key>& keys,
                           KeyTable table) {
  std::set<std::string> names;
  for (const Key& key : keys) {
    if (!is_plain_name(key.path) || !names.insert(key.path).second)
      throw UsageError(fmt::format("the {} '{}' has a key '{}' (names have small letters, digits and '_', and each is "
                                   "there once); rename it",
                                   what, name, key.path));
    if (!is_complete(key))
      throw UsageError(fmt::format("the key '{}' of the {} '{}' is incomplete (it needs a fallback or an example, a "
                                   "choice its choices, rows their columns, and none has alternatives); complete it",
                                   key.path, what, name));
    if (table == KeyTable::shared && key.path == "law")
      fail_taken_key(what, name, key.path);
    if (table == KeyTable::shared && !key.only_with.key.empty())
      throw UsageError(
          fmt::format("the key '{}' of the {} '{}' depends on another key, which keys of a {} cannot; remove "
                      "the condition",
                      key.path, what, name, what));
  }
}

void fail_taken(const std::string& what, const std::string& name) {
  throw UsageError(fmt::format("there is a {0} '{1}' already; give this {0} another name", what, name));
}

void fail_taken_key(const std::string& what, const std::string& name, const std::string& key) {
  throw UsageError(
      fmt::format("the key '{}' of the {} '{}' is in its table already; give it another name", key, what, name));
}

} // namespace keeler
