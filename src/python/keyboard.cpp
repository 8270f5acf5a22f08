#include "keyboard.hpp"

#include <pybind11/pybind11.h>

namespace keeler::python {
namespace {

struct sigaction before; // the interpreter's

bool in_main_thread() {
  const auto threading = pybind11::module_::import("threading");
  return threading.attr("current_thread")().is(threading.attr("main_thread")());
}

} // namespace

Keyboard::Keyboard() : main_(in_main_thread()) {
  if (!main_)
    return;
  struct sigaction present;
  sigaction(SIGINT, nullptr, &present);
  if (present.sa_handler == note) // below a computation, in a force of Python: that one watches
    return;
  before = present;
  if ((before.sa_flags & SA_SIGINFO) != 0 || before.sa_handler == SIG_DFL || before.sa_handler == SIG_IGN)
    return; // not Python's handler
  stop_ = give_up_ = undelivered_ = false;
  struct sigaction now = before;
  now.sa_handler = note;
  watching_ = sigaction(SIGINT, &now, nullptr) == 0;
}

Keyboard::~Keyboard() {
  if (!watching_)
    return;
  sigaction(SIGINT, &before, nullptr);
  deliver();
}

void Keyboard::note(int signal) {
  if (!stop_.exchange(true)) {
    undelivered_ = true;
    return;
  }
  give_up_ = true;
  before.sa_handler(signal);
}

void Keyboard::deliver() const {
  if (watching_ && undelivered_.exchange(false))
    before.sa_handler(SIGINT);
}

void raise_interrupts() {
  if (PyErr_CheckSignals() != 0)
    throw pybind11::error_already_set();
}

} // namespace keeler::python
