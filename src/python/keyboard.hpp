// Ctrl-C while Keeler computes without the interpreter's lock. Python's handler only sets a flag, which the interpreter
// reads when it next runs code. That may be a force of Python, whose step would be lost: so the first Ctrl-C reaches
// the handler after the computation.
#pragma once

#include <atomic>

#include <csignal>

namespace keeler::python {

/// Counts interrupts during its lifetime, in the interpreter's main thread. In other threads, which receive no
/// interrupts, it reports only the end of the interpreter. Precondition: the interpreter's lock is held.
class Keyboard {
public:
  Keyboard();
  ~Keyboard();
  Keyboard(const Keyboard&) = delete;
  Keyboard& operator=(const Keyboard&) = delete;

  /// True after a first interrupt: stop after the current step. give_up() is true after a second: abandon the step.
  bool stop() const { return watching_ && stop_; }
  const std::atomic<bool>& stop_flag() const { return watching_ ? stop_ : when_it_ends(); }
  const std::atomic<bool>& give_up() const { return watching_ ? give_up_ : when_it_ends(); }

  /// Calls the interpreter's handler for a Ctrl-C that it has not seen. The destructor does so too.
  void deliver() const;

  /// Makes all other threads abandon their computations.
  static void end_others() { ends_ = true; }

private:
  static void note(int signal);
  const std::atomic<bool>& when_it_ends() const { return main_ ? never_ : ends_; }

  // static, since a signal handler has no object
  static inline std::atomic<bool> stop_ = false, give_up_ = false, undelivered_ = false;
  static inline std::atomic<bool> ends_ = false; // the interpreter ends
  static constexpr std::atomic<bool> never_ = false;
  bool main_, watching_ = false;
};

/// Raises the exception of the interpreter's signal handlers, usually KeyboardInterrupt. Precondition: the
/// interpreter's lock is held.
void raise_interrupts();

} // namespace keeler::python
