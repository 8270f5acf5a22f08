// Numbers and counts in the words of messages and tables for people.
#pragma once

#include <cstdint>
#include <string>

namespace keeler {

/// A number to so many significant digits: without an exponent from 1e-4 to below 1e7 ("1230", "0.012"), else with a
/// short one ("1.2e9").
std::string format_number(double value, int digits = 6);

/// "1 thread", "2 threads".
std::string pluralize(std::uint64_t count, const std::string& noun);

/// A line that terminals and logs can take, whatever words of others it repeats: control characters and what is no
/// UTF-8 become '?', and of more than 2000 bytes the middle is left out.
std::string printable_line(const std::string& line);

} // namespace keeler
