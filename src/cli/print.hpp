// Standard output: results for people and for programs. All that commands print passes here.
#pragma once

#include <keeler/core/json_of_files.hpp>
#include <keeler/core/printable.hpp>
#include <keeler/quantities/views.hpp>

#include <fmt/format.h>

#include <utility>

namespace keeler {

/// Prints as fmt::print does, without what a terminal would obey: files of others have titles and attributes too.
template<class... Values> void print(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print("{}", printable_text(fmt::format(format, std::forward<Values>(values)...)));
}

/// Prints numbers as lines, or as JSON.
inline void print_record(const Record& record, bool as_json) {
  print("{}", as_json ? json_text(json_of(record), 2) + "\n" : lines_of(record));
}

} // namespace keeler
