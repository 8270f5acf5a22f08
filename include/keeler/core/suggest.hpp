// "Did you mean": the known name that a misspelt one is closest to.
#pragma once

#include <string>
#include <vector>

namespace keeler {

/// The closest candidate, or "" when none is within a third of the length of the word (at least one edit). An edit
/// inserts, deletes or changes a letter, or swaps two neighbours (optimal string alignment).
std::string closest(const std::string& word, const std::vector<std::string>& candidates);

} // namespace keeler
