// Overrides from the command line: "a.b=value" on top of a scene file.
#pragma once

#include "document.hpp"

#include <string>
#include <vector>

namespace keeler {

/// Puts the overrides into the document. What the file says against an override (another way to give the same thing, a
/// key of another law, the sections that a start file replaces) is dropped, with a notice each.
void apply_overrides(Document& document, const std::vector<std::string>& overrides, std::vector<std::string>& notices);

/// The same for the snapshot of --from.
void apply_start(Document& document, const std::string& snapshot, std::vector<std::string>& notices);

} // namespace keeler
