// Limits on a TOML text, checked before it is parsed, and messages for syntax errors. Parsers, and code that walks over
// their result, recurse into tables and lists, and the path of a table grows with its depth: without limits a text of a
// few kB exhausts stack or memory.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace keeler::files {

/// Limit on the parts of a dotted name, and on nested lists and tables. Keeler's own files have 4 at most.
inline constexpr std::size_t max_toml_depth = 16;

/// Location and kind of an excess.
struct TomlExcess {
  std::size_t line = 1, column = 1; ///< from 1; columns count characters of UTF-8
  std::string what;                 ///< message
};

/// Returns the first location where a text nests too deeply, or its beginning if it is too long. Strings and comments
/// are skipped as in TOML, up to the first syntax error.
std::optional<TomlExcess> toml_excess(std::string_view text);

/// Throws UsageError "NAME:LINE:COLUMN: …" if a text exceeds a limit.
void require_bounded_toml(std::string_view text, const std::string& name);

/// Returns the message for a syntax error that a parser describes by `description`.
std::string toml_fault(std::string_view description);

} // namespace keeler::files
