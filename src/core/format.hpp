// Formats numbers and counts for messages and tables.
#pragma once

#include <cstdint>
#include <string>

namespace keeler {

/// Formats a number to `digits` (> 0) significant digits: without an exponent in [1e-4, 1e7) ("1230", "0.012"), else
/// with a short one ("1.2e9").
std::string format_number(double value, int digits = 6);

/// Returns "1 thread", "2 threads".
std::string pluralize(std::uint64_t count, const std::string& noun);

/// Returns a line that is safe for terminals and logs, even if it quotes foreign text: control characters and invalid
/// UTF-8 become '?', and the middle of more than 2000 bytes is omitted.
std::string printable_line(const std::string& line);

} // namespace keeler
