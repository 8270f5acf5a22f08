// The table of finders by name; each is one form of motion with one form of search.
#pragma once

#include <keeler/finders/finder.hpp>

#include <memory>
#include <span>
#include <string>

namespace keeler::finders {

struct FinderEntry {
  const char* name;
  const char* about;
  std::unique_ptr<Finder> (*make)();
};

/// Returns all finders, the default first.
std::span<const FinderEntry> finder_table();

/// Returns the finder of that name, or null.
std::unique_ptr<Finder> make_finder(const std::string& name);

} // namespace keeler::finders
