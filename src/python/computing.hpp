// Long computations for Python: without the interpreter's lock, and interruptible.
#pragma once

#include "keyboard.hpp"

#include <keeler/core/interrupt.hpp>

#include <pybind11/pybind11.h>

namespace keeler::python {

/// Throws Error (run_time) in a process that was forked after its parent had computed: it would wait for threads that
/// the fork did not copy.
void require_own_threads();

/// Releases the interpreter's lock during its lifetime. If the interpreter ends meanwhile, the thread blocks forever
/// after its work: otherwise the interpreter would end it inside C++. Precondition: the thread holds the lock.
class Unlocked {
public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

private:
  PyThreadState* state_;
};

/// Interrupts the computations of other threads and waits for them. Called when the interpreter is about to end.
void end_other_threads();

/// Returns make(), without the interpreter's lock. An interrupt ends it at once, without a result.
template<class Make> auto make_interruptibly(const Make& make) {
  require_own_threads();
  const Keyboard keyboard;
  try {
    const Interruptible by_keyboard(keyboard.stop_flag());
    const Unlocked unlocked;
    return make();
  } catch (const Interrupted&) {
    keyboard.deliver();
    raise_interrupts();
    throw;
  }
}

} // namespace keeler::python
