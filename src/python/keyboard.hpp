// Ctrl-C while Keeler computes without the interpreter's lock: Python's own handler only makes a note, which nobody
// reads until the computation returns.
#pragma once

#include <atomic>

#include <csignal>

namespace keeler::python {

/// While it lives, in the interpreter's main thread, interrupts are counted here as well. In other threads it only
/// says when the interpreter ends: it is the main thread that the interpreter tells of interrupts. To be made with the
/// interpreter's lock held.
class Keyboard {
public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// Since it was made: whether to stop when what is at hand is done, and whether to give that up.
  bool stop() const { return watching_ && stop_; }
  const std::atomic<bool>& stop_flag() const { return watching_ ? stop_ : when_it_ends(); }
  const std::atomic<bool>& give_up() const { return watching_ ? give_up_ : when_it_ends(); }

  /// From now on the work of other threads is to be given up.
  static void end_others() { ends_ = true; }

private:
  static void note(int signal);
  const std::atomic<bool>& when_it_ends() const { return main_ ? never_ : ends_; }

  static inline std::atomic<bool> stop_ = false, give_up_ = false; // a handler has no object
  static inline std::atomic<bool> ends_ = false;                   // the interpreter
  static constexpr std::atomic<bool> never_ = false;
  bool main_, watching_ = false;
};

/// Raises what the interpreter's handlers of signals raise, KeyboardInterrupt as a rule. With the lock held.
void raise_interrupts();

} // namespace keeler::python
