// How long work is done for Python: without the interpreter's lock, and so that an interrupt ends it.
#pragma once

#include "keyboard.hpp"

#include <keeler/core/interrupt.hpp>

#include <pybind11/pybind11.h>

namespace keeler::python {

/// Computing in a process that was forked after its parent had computed would wait for threads that the fork did not
/// copy. Throws Error (run_time) there.
void require_own_threads();

/// Without the interpreter's lock as long as it lives. When the interpreter ends meanwhile, the thread stands still for
/// good once its work is done: the interpreter would end it inside C++.
class Unlocked {
public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

private:
  PyThreadState* state_;
};

/// Interrupts what other threads compute and waits for them: the interpreter is about to end.
void end_other_threads();

/// What `make` makes. An interrupt ends it at once: nothing could be kept.
template<class Make> auto made(const Make& make) {
  require_own_threads();
  const Keyboard keyboard;
  try {
    const Interruptible by_keyboard(keyboard.stop_flag());
    const Unlocked unlocked;
    return make();
  } catch (const Interrupted&) {
    raise_interrupts();
    throw;
  }
}

} // namespace keeler::python
