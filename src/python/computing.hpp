// How long work is done for Python: without the interpreter's lock, and so that an interrupt ends it.
#pragma once

#include "keyboard.hpp"

#include <keeler/core/interrupt.hpp>

#include <pybind11/pybind11.h>

namespace keeler::python {

/// Computing in a process that was forked after its parent had computed would wait for threads that the fork did not
/// copy. Throws Error (run_time) there.
void require_own_threads();

/// What `make` makes. An interrupt ends it at once: nothing could be kept.
template<class Make> auto made(const Make& make) {
  require_own_threads();
  const Keyboard keyboard;
  try {
    const Interruptible by_keyboard(keyboard.stop_flag());
    const pybind11::gil_scoped_release unlocked;
    return make();
  } catch (const Interrupted&) {
    raise_interrupts();
    throw;
  }
}

} // namespace keeler::python
