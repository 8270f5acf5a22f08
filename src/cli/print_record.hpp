// Prints records of numbers on standard output.
#pragma once

#include "print.hpp"

#include <keeler/core/json_of_files.hpp>
#include <keeler/quantities/views.hpp>

namespace keeler::cli {

/// Prints the numbers as lines, or as JSON.
inline void print_record(const quantities::Record& record, bool as_json) {
  print("{}", as_json ? json_text(json_of(record), 2) + "\n" : lines_of(record));
}

} // namespace keeler::cli
