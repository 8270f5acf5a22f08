// Checks a document against its schema.
#pragma once

#include <keeler/config/document.hpp>

#include <string>

namespace keeler::config {

/// Throws UsageError for the first fault: unknown names, wrong types and values out of range, then contradictions, then
/// missing keys. Messages call the file `name`.
void check_document(const TomlDocument& document, const std::string& name);

/// True if the condition of a key (another key, or its value) holds, by the document or by default. Precondition: the
/// schema has the path.
bool condition_holds(const TomlDocument& document, const std::string& path);

} // namespace keeler::config
