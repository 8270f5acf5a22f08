// Progress of making a start.
#pragma once

namespace keeler {

struct StartProgress {
  double fraction = 0.0;    ///< of the work done, an estimate; 1 at the end
  double elapsed_s = 0.0;   ///< wall time
  double remaining_s = 0.0; ///< an estimate
};

} // namespace keeler
