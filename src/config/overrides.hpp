// Overrides on top of a file: "a.b=value" of the command line, or keys that another file gives.
#pragma once

#include <keeler/config/document.hpp>

#include <string>
#include <vector>

namespace keeler::config {

/// A key that gets another value than the file gives it.
struct Override {
  std::string key, value;                   ///< value: TOML, or a bare word
  std::string key_location, value_location; ///< for messages
};

/// Puts an override into the document. What the file says against the override (an alternative to its key, a key of
/// another law, the sections that its key replaces) is removed, with a notice each.
void apply_override(TomlDocument& document, const Override& override, std::vector<std::string>& notices);

/// As apply_override(), for a string that is taken verbatim; messages call it `location`.
void apply_text(TomlDocument& document, const std::string& path, const std::string& text, const std::string& location,
                std::vector<std::string>& notices);

/// Applies "a.b=value" texts in their order, a later one on top of an earlier one. Throws UsageError if one is not
/// KEY=VALUE, or if there are more than 1000.
void apply_overrides(TomlDocument& document, const std::vector<std::string>& overrides,
                     std::vector<std::string>& notices);

} // namespace keeler::config
