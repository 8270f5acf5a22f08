// Numbers and counts in the words of messages and tables for people.
#pragma once

#include <cstdint>
#include <string>

namespace keeler {

/// A number to so many significant digits: without an exponent from 1e-4 to below 1e7 ("1230", "0.012"), else with a
/// short one ("1.2e9").
std::string figures(double value, int digits = 6);

/// "1 thread", "2 threads".
std::string counted(std::uint64_t count, const std::string& noun);

} // namespace keeler
