// The finders by name: each is one form of motion under one form of search, and one line of the table.
#pragma once

#include <keeler/collision/pair.hpp>

#include <span>
#include <string>

namespace keeler {

using Finder = FinderResult (*)(const Pair&, const Frequencies&);

struct FinderEntry {
  const char* name;
  const char* about;
  Finder find;
};

/// All finders, the default first.
std::span<const FinderEntry> finder_table();

/// The finder of that name, or null.
Finder finder_named(const std::string& name);

} // namespace keeler
