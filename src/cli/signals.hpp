// Signals: INT, TERM, HUP and USR1 ask the run to finish its step, write a checkpoint and stop; when that takes longer
// than the run's patience, or at a second one, to give the step up. A third one ends the program. Signals within a
// quarter of a second of the first are the same request: a queue sends one to each process of a job, and a sweep passes
// it on to its runs as well. USR2 asks for a snapshot.
#pragma once

#include <keeler/runs/run.hpp>

namespace keeler {

/// The requests that the handlers set. Installs the handlers.
RunRequests& requests_from_signals();

} // namespace keeler
