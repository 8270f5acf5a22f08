// Standard output: results for people and for programs. All that commands print passes here.
#pragma once

#include <keeler/core/printable.hpp>

#include <fmt/format.h>

#include <utility>

namespace keeler {

/// Prints as fmt::print does, without what a terminal would obey: files of others have titles and attributes too.
template<class... Values> void print(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print("{}", printable_text(fmt::format(format, std::forward<Values>(values)...)));
}

} // namespace keeler
