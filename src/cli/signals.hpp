// Signals. INT, TERM, HUP and USR1 request a stop: the run finishes its step, writes a checkpoint and stops. A second
// signal, or a stop that takes too long, makes it give up the step. A third signal ends the
// program. Signals within a quarter of a second of the first count as one request: a batch system signals every process
// of a job, and a sweep also passes the signal on to its runs. USR2 requests a snapshot. The signals are blocked from
// the start of the program until the command line is read, so that none arrives before its handler is installed.
#pragma once

#include <keeler/core/interrupt.hpp>
#include <keeler/runs/run.hpp>

#include <string>

namespace keeler::cli {

/// Blocks these signals, also across exec().
void hold_signals();
/// Unblocks these signals.
void release_signals();

/// Installs the handlers and returns the requests that they set. A stop also ends waiting for a pipe or a device.
runs::RunRequests& requests_from_signals();

/// Returns make(), for work without checkpoints: the first signal interrupts it at once, and Error with this message is
/// thrown.
template<class Make> auto unless_stopped(const std::string& message, const Make& make) {
  try {
    const Interruptible by_signals(requests_from_signals().stop);
    return make();
  } catch (const Interrupted&) {
    throw Error(ExitCode::run_time, message);
  }
}

} // namespace keeler::cli
