// What scenes and output call by name: forces, laws, columns. A registry has Keeler's entries and then those that the
// calling program adds, in the order of their names, so that results do not depend on the order in which they came.
#pragma once

#include <keeler/core/key.hpp>

#include <algorithm>
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
[[noreturn]] void fail_late(const std::string& what, const std::string& name);

/// Entries with a name, and some with `keys`. Safe in several threads.
template<class Entry> class Registry {
public:
  Registry(std::string what, const char* Entry::*name, std::vector<Entry> of_keeler, KeyTable table = KeyTable::own)
      : what_(std::move(what)), name_(name), table_(table), of_keeler_(of_keeler.size()),
        entries_(std::move(of_keeler)) {}

  /// Throws UsageError if the name or a key is invalid or taken, or after the first call of entries().
  void add(Entry entry) {
    require_registrable_name(what_, entry.*name_);
    if constexpr (requires { entry.keys; })
      require_complete_keys(what_, entry.*name_, entry.keys, table_);
    const std::lock_guard lock(guard_);
    for (const Entry& other : entries_)
      require_different(entry, other);
    if (read_)
      fail_late(what_, entry.*name_);
    const auto after = [&](const Entry& a, const Entry& b) { return name_of(a) < name_of(b); };
    const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(of_keeler_);
    entries_.insert(std::upper_bound(first, entries_.end(), entry, after), std::move(entry));
  }

  /// Returns all entries, which never change from then on: others may refer to them.
  const std::vector<Entry>& entries() {
    const std::lock_guard lock(guard_);
    read_ = true;
    return entries_;
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
  std::vector<Entry> entries_;
  bool read_ = false;
};

} // namespace keeler
