// Standard output of all commands: results as text and as JSON.
#pragma once

#include <keeler/core/printable.hpp>

#include <fmt/format.h>

#include <utility>

namespace keeler::cli {

/// Prints as fmt::print does, without control characters: titles and attributes come from files of unknown origin.
template<class... Values> void print(fmt::format_string<Values...> format, Values&&... values) {
  fmt::print("{}", printable_text(fmt::format(format, std::forward<Values>(values)...)));
}

} // namespace keeler::cli
