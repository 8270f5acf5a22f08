// Progress of a long measurement.
#pragma once

#include <string>

namespace keeler {

struct Progress {
  double fraction = 0.0; ///< of the work done, 0 … 1
  double elapsed_s = 0.0, remaining_s = 0.0;
  std::string what; ///< current phase
};

} // namespace keeler
