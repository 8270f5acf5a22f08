// How far a long measurement is.
#pragma once

#include <string>

namespace keeler {

struct Progress {
  double share = 0.0; ///< of the work done, 0 … 1
  double elapsed_s = 0.0, remaining_s = 0.0;
  std::string what; ///< is being done
};

} // namespace keeler
