// The finders by name: each is one form of motion under one form of search, and one line of the table.
#pragma once

#include <keeler/finders/finder.hpp>

#include <memory>
#include <span>
#include <string>

namespace keeler {

struct FinderEntry {
  const char* name;
  const char* about;
  std::unique_ptr<Finder> (*make)();
};

/// All finders, the default first.
std::span<const FinderEntry> finder_table();

/// A finder of that name, or null.
std::unique_ptr<Finder> make_finder(const std::string& name);

} // namespace keeler
