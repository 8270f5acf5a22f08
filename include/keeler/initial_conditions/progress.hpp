// Where the making of a start stands.
#pragma once

namespace keeler {

struct StartProgress {
  double share = 0.0;       ///< of the work, an estimate; 1 at the end
  double elapsed_s = 0.0;   ///< wall time
  double remaining_s = 0.0; ///< an estimate
};

} // namespace keeler
