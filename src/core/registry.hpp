// What scenes and output call by name: forces, laws, columns. A registry has Keeler's entries and then those that the
// calling program adds, in the order of their names, so that results do not depend on the order in which they came.
// Entries that a reader has seen never change or move, since scenes refer to them: a later addition makes a new list,
// and the earlier ones are kept.
#pragma once

#include <keeler/core/key.hpp>

#include <algorithm>
#include <list>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace keeler {

/// Where scenes write the keys of entries: each entry has a table of its own, or all share one with the key "law".
enum class KeyTable { own, shared };

/// Throw UsageError about an entry to be added; `what` says in messages what it is, for example "force".
/// Its name must begin with a letter and have only small letters, digits and '_'.
void require_registrable_name(const std::string& what, const char* name);
/// Its keys must be complete, without alternatives, and have names like entries; in a shared table none is called "law"
/// or has a condition, since the entry's name is the condition of each.
void require_complete_keys(const std::string& what, const std::string& name, const std::vector<Key>& keys,
                           KeyTable table);
[[noreturn]] void fail_taken(const std::string& what, const std::string& name);
[[noreturn]] void fail_taken_key(const std::string& what, const std::string& name, const std::string& key);

/// Entries with a name, and some with `keys`. Safe in several threads.
template<class Entry> class Registry {
public:
  Registry(std::string what, const char* Entry::*name, std::vector<Entry> of_keeler, KeyTable table = KeyTable::own)
      : what_(std::move(what)), name_(name), table_(table), of_keeler_(of_keeler.size()) {
    lists_.push_back(std::move(of_keeler));
  }

  /// Throws UsageError if the name or a key is invalid or taken. With IfTaken::replace an entry of the calling program
  /// takes the place of an earlier one of its name.
  void add(Entry entry, IfTaken if_taken = IfTaken::refuse) {
    require_registrable_name(what_, entry.*name_);
    if constexpr (requires { entry.keys; })
      require_complete_keys(what_, entry.*name_, entry.keys, table_);
    const std::lock_guard lock(guard_);
    std::vector<Entry> next = lists_.back();
    const auto first = next.begin() + static_cast<std::ptrdiff_t>(of_keeler_);
    if (if_taken == IfTaken::replace)
      next.erase(
          std::remove_if(first, next.end(), [&](const Entry& other) { return name_of(other) == name_of(entry); }),
          next.end());
    for (const Entry& other : next)
      require_different(entry, other);
    const auto after = [&](const Entry& a, const Entry& b) { return name_of(a) < name_of(b); };
    next.insert(std::upper_bound(first, next.end(), entry, after), std::move(entry));
    lists_.push_back(std::move(next));
  }

  /// Returns all entries at present. The list never changes and is never freed.
  const std::vector<Entry>& entries() {
    const std::lock_guard lock(guard_);
    return lists_.back();
  }

private:
  std::string_view name_of(const Entry& entry) const { return entry.*name_; }

  void require_different(const Entry& entry, const Entry& other) const {
    if (name_of(entry) == name_of(other))
      fail_taken(what_, entry.*name_);
    if constexpr (requires { entry.keys; })
      for (const Key& key : entry.keys) {
        const auto same = [&](const Key& k) { return k.path == key.path; };
        if (table_ == KeyTable::shared && std::any_of(other.keys.begin(), other.keys.end(), same))
          fail_taken_key(what_, entry.*name_, key.path);
      }
  }

  std::string what_;
  const char* Entry::*name_;
  KeyTable table_;
  std::size_t of_keeler_;
  std::mutex guard_;
  std::list<std::vector<Entry>> lists_; // the last is in force
};

} // namespace keeler
