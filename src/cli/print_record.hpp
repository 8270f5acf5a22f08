// Prints records of numbers on standard output.
#pragma once

#include "print.hpp"

#include <keeler/core/json_of_files.hpp>
#include <keeler/quantities/views.hpp>

namespace keeler::cli {

/// Prints the numbers as lines, or as JSON, in their default units or in the units of `system`.
inline void print_record(const quantities::Record& record, bool as_json,
                         std::optional<quantities::UnitSystem> system = std::nullopt) {
  print("{}", as_json ? json_text(json_of(record, system), 2) + "\n" : lines_of(record, system));
}

} // namespace keeler::cli
