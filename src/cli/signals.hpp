// Signals: INT, TERM, HUP and USR1 ask the run to finish its step, write a checkpoint and stop; a second one ends the
// program at once. USR2 asks for a snapshot.
#pragma once

#include <keeler/runs/run.hpp>

namespace keeler {

/// The requests that the handlers set. Installs the handlers at the first call.
RunRequests& requests_from_signals();

} // namespace keeler
