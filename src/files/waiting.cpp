#include "waiting.hpp"

#include <keeler/core/interrupt.hpp>

#include <fmt/format.h>

#include <cerrno>

#include <poll.h>

namespace keeler::files {

void require_patience(const std::filesystem::path& file) {
  if (interrupted() || Interruptible::waits_are_over())
    throw Interrupted(fmt::format("stopped (on request) while it waited for '{}'", file.string()));
}

void await(int descriptor, short events, const std::filesystem::path& file) {
  pollfd wanted = {descriptor, events, 0};
  for (;;) {
    require_patience(file);
    const int ready = ::poll(&wanted, 1, patience_ms);
    if (ready > 0 || (ready < 0 && errno != EINTR)) // the next call will report an error that poll cannot
      return;
  }
}

} // namespace keeler::files
