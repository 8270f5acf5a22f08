// The tables of the numbers that commands print, for keeler help.
#pragma once

#include <keeler/quantities/quantity.hpp>

#include <vector>

namespace keeler::cli {

struct NumberTable {
  const char* title;
  std::vector<quantities::Quantity> quantities;
};

/// The tables of commands that the demo's program leaves out; none in that program.
std::vector<NumberTable> further_number_tables();

} // namespace keeler::cli
