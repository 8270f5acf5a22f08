// "Did you mean": the known name that a misspelt one is closest to.
#pragma once

#include <string>
#include <vector>

namespace keeler {

/// Insertions, deletions, changes and swaps of neighbours that turn one into the other (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The closest candidate, or "" when none is within a third of the length of the word (at least one edit).
std::string closest(const std::string& word, const std::vector<std::string>& candidates);

/// What to write for an unknown key path: a key or table near in the same table, or one of that name elsewhere.
std::string suggest_path(const std::string& path);

} // namespace keeler
