// Giving up work that takes too long: a start that is not wanted any more, a step that does not end.
//
// Whoever calls such work names a flag for the time of the call. Another thread or a signal handler sets it; parallel
// loops (threads.hpp), and the loops that look at it by themselves, then throw Interrupted. What the work was to change
// is left half done and must not be used.
#pragma once

#include <keeler/core/error.hpp>

#include <atomic>

namespace keeler {

struct Interrupted : Error {
  Interrupted() : Interrupted("interrupted on request") {}
  explicit Interrupted(const std::string& message) : Error(ExitCode::run_time, message) {}
};

/// Work of this thread, and of the parallel loops in it, can be interrupted by the flag as long as this lives.
class Interruptible {
public:
  explicit Interruptible(const std::atomic<bool>& flag) : before_(current_) { current_ = &flag; }
  ~Interruptible() { current_ = before_; }
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  /// The flag of this thread's work.
  static const std::atomic<bool>& flag() { return *current_; }

  /// From now on this flag ends what waits for others, such as the writer of a pipe: in all threads, and whatever work
  /// there is, since a wait may have no end and leaves nothing half done.
  static void waits_end_by(const std::atomic<bool>& flag) { of_waits_ = &flag; }
  static bool waits_are_over() { return of_waits_.load()->load(std::memory_order_relaxed); }

private:
  static constexpr std::atomic<bool> never_ = false;
  static constinit thread_local inline const std::atomic<bool>* current_ = &never_;
  static constinit inline std::atomic<const std::atomic<bool>*> of_waits_ = &never_;

  const std::atomic<bool>* before_;
};

/// Whether the work at hand is to be given up. Costs a few instructions.
inline bool interrupted() {
  return Interruptible::flag().load(std::memory_order_relaxed);
}

/// Throws Interrupted when the work at hand is to be given up.
inline void throw_if_interrupted() {
  if (interrupted())
    throw Interrupted();
}

} // namespace keeler
