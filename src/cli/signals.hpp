// Signals: INT, TERM, HUP and USR1 ask the run to finish its step, write a checkpoint and stop; when that takes longer
// than the run's patience, or at a second one, to give the step up. A third one ends the program. Signals within a
// quarter of a second of the first are the same request: a queue sends one to each process of a job, and a sweep passes
// it on to its runs as well. USR2 asks for a snapshot. A process holds them back from its begin until the command line
// is read, so that none comes before the handlers of the commands that have some.
#pragma once

#include <keeler/core/interrupt.hpp>
#include <keeler/runs/run.hpp>

#include <string>

namespace keeler {

/// Holds these signals back, in the program that takes this one's place by exec() too, and lets them come.
void hold_signals();
void release_signals();

/// The requests that the handlers set. Installs the handlers; a stop also ends what waits for a pipe or a device.
RunRequests& requests_from_signals();

/// What make() returns. The first signal is heeded at once, where nothing could be kept: then throws Error with this
/// message.
template<class Make> auto unless_stopped(const std::string& message, const Make& make) {
  try {
    const Interruptible by_signals(requests_from_signals().stop);
    return make();
  } catch (const Interrupted&) {
    throw Error(ExitCode::run_time, message);
  }
}

} // namespace keeler
