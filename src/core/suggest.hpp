// "Did you mean": the known name closest to a misspelt one.
#pragma once

#include <string>
#include <vector>

namespace keeler {

/// Returns the closest candidate, or "" if none is within a third of the word's length in edits (at least one). An edit
/// inserts, deletes or changes a letter, or swaps two adjacent letters (optimal string alignment distance).
std::string closest(const std::string& word, const std::vector<std::string>& candidates);

} // namespace keeler
