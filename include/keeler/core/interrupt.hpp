// Cancellation of long work, such as the generation of a state or a step that takes too long.
//
// The caller of such work registers a flag for its duration (Interruptible). When another thread or a signal handler
// raises the flag, parallel loops (threads.hpp), and other loops that check it, throw Interrupted. Data that
// the work was changing is then incomplete and must not be used.
#pragma once

#include <keeler/core/error.hpp>

#include <atomic>

namespace keeler {

/// Work was abandoned on request. Its exit code is ExitCode::run_time.
struct Interrupted : Error {
  Interrupted() : Interrupted("interrupted on request") {}
  /// With a message that says why.
  explicit Interrupted(const std::string& message) : Error(ExitCode::run_time, message) {}
};

/// During its lifetime, the flag interrupts work of this thread and of parallel loops in it. Precondition: the flag
/// outlives this object; objects nest.
class Interruptible {
public:
  /// Registers the flag for work of this thread.
  explicit Interruptible(const std::atomic<bool>& flag) : before_(current_) { current_ = &flag; }
  ~Interruptible() { current_ = before_; }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  /// Returns the flag of this thread's work.
  static const std::atomic<bool>& flag() { return *current_; }

  /// Sets the flag that ends waiting for other processes, such as the writer of a pipe, in all threads: such a wait may
  /// never end, and interrupting it leaves no incomplete data. Precondition: the flag outlives all waits.
  static void waits_end_by(const std::atomic<bool>& flag) { of_waits_ = &flag; }
  /// True if the flag that ends waiting is raised.
  static bool waits_are_over() { return of_waits_.load()->load(std::memory_order_relaxed); }

private:
  static constexpr std::atomic<bool> never_ = false;
  static constinit thread_local inline const std::atomic<bool>* current_ = &never_;
  static constinit inline std::atomic<const std::atomic<bool>*> of_waits_ = &never_;

  const std::atomic<bool>* before_;
};

/// True if the current work is to be abandoned. Costs a few instructions.
inline bool interrupted() {
  return Interruptible::flag().load(std::memory_order_relaxed);
}

/// Throws Interrupted if the current work is to be abandoned.
inline void throw_if_interrupted() {
  if (interrupted())
    throw Interrupted();
}

} // namespace keeler
