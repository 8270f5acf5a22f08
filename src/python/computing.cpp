#include "computing.hpp"

#include <keeler/core/error.hpp>

#include <atomic>

#include <unistd.h>

namespace keeler::python {
namespace {

std::atomic<pid_t> computed_in = 0; // the process whose threads there are

} // namespace

void require_own_threads() {
  pid_t none = 0;
  if (computed_in.compare_exchange_strong(none, getpid()) || none == getpid())
    return;
  throw Error(ExitCode::run_time, "this process was forked from one in which Keeler had computed, and threads do not "
                                  "survive that; start it by multiprocessing's \"spawn\" or \"forkserver\"");
}

} // namespace keeler::python
