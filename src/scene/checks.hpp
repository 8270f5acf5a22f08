// What the key table alone says about a document.
#pragma once

#include "document.hpp"

#include <string>

namespace keeler {

/// Throws UsageError for the first fault: unknown names, wrong types, values out of range, contradictions, then what is
/// missing. `name` stands for the file.
void check_document(const SceneDocument& document, const std::string& name);

/// Whether what the key depends on (another key, another key's value) is given or is the default.
bool condition_holds(const SceneDocument& document, const std::string& path);

} // namespace keeler
