// Tables of numbers under names, as text: what spreadsheets, numpy and pandas write as CSV.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace keeler {

struct Columns {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values; ///< by column; may be NaN or infinite where the text says so
  std::size_t header_line = 0;
  std::vector<std::size_t> lines; ///< of each row, from 1
};

/// A line of names, then a line of numbers for each row. What parts the names parts the numbers: commas, semicolons, or
/// blanks and tabs. Empty lines and lines that begin with '#' are left out, but the names may stand behind a '#' where
/// no line of names comes before the numbers. Throws UsageError "NAME:LINE: what is wrong; what to do".
Columns parse_columns(std::string_view text, const std::string& name);

} // namespace keeler
