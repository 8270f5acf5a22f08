// What ranks are asked for: each has a command line and files of its own, and a run needs the same on all of them.
#pragma once

#include <keeler/comm/communicator.hpp>

#include <string>
#include <vector>

namespace keeler {

/// One thing that a process is asked for: an option, or a key of a scene.
struct Asked {
  std::string name, value; ///< as messages show them: "time.end", "2.0"
};

/// Collective. Throws UsageError, which names the first difference, where a rank is asked for something else than the
/// first one. Each name occurs once.
void require_same_request(const std::vector<Asked>& request, const Communicator& ranks);

} // namespace keeler
