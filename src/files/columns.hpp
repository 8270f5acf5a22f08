// Tables of named columns of numbers in a text: CSV as spreadsheets, numpy and pandas write it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace keeler::files {

struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values; ///< by column; NaN and infinity are accepted
  std::size_t header_line = 0;             ///< line of the names, from 1
  std::vector<std::size_t> lines;          ///< line of each row, from 1
};

/// Parses a line of names and then one line of numbers per row. Names and numbers have the same separator: commas,
/// semicolons, or blanks and tabs. Empty lines and comments ('#') are skipped; if no line of names precedes the
/// numbers, the names are taken from a comment. Throws UsageError "NAME:LINE: what is wrong; what to do".
Columns parse_columns(std::string_view text, const std::string& name);

} // namespace keeler::files
