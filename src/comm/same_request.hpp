// Check that all ranks were started with the same request: each process reads its own command line and files, and a run
// needs the same on all ranks.
#pragma once

#include <keeler/comm/communicator.hpp>

#include <string>
#include <vector>

namespace keeler::comm {

/// One entry of a request: an option of the command line, or a key of a scene.
struct RequestEntry {
  std::string name, value; ///< as messages show them: "time.end", "2.0"
};

/// Throws UsageError on all ranks if the request of any rank differs from the root's; the message names the first
/// difference. Collective. Precondition: each name occurs once.
void require_same_request(const std::vector<RequestEntry>& request, const Communicator& ranks);

} // namespace keeler::comm
