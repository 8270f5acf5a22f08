// Bounds on a TOML text before it is parsed, and what is said of one that is none. Parsers, and what walks over their
// result, recurse into tables and lists, and the path of a table in others grows with its depth: without a bound a text
// of a few kB exhausts stack or memory.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace keeler {

/// Parts of a dotted name, and lists or tables inside each other. What Keeler reads has 4 at most.
inline constexpr std::size_t max_toml_depth = 16;

/// Where a text exceeds a bound, and in which way.
struct TomlExcess {
  std::size_t line = 1, column = 1; ///< from 1; columns count characters of UTF-8
  std::string what;
};

/// The first place where a text nests too deep, or its end where it is too long. Up to the first fault of syntax it
/// reads strings and comments as TOML does.
std::optional<TomlExcess> toml_excess(std::string_view text);

/// Throws UsageError "NAME:LINE:COLUMN: …" where a text exceeds a bound.
void require_bounded_toml(std::string_view text, const std::string& name);

/// Returns the sentence for a fault of syntax that a parser describes in these words.
std::string toml_fault(std::string_view description);

} // namespace keeler
