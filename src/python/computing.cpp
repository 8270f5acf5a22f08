#include "computing.hpp"

#include <keeler/core/error.hpp>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include <unistd.h>

namespace keeler::python {
namespace {

std::atomic<pid_t> computed_in = 0; // the process whose threads there are

// Threads that are without the interpreter's lock, and whether they may take it again.
struct Others {
  std::mutex guard;
  std::condition_variable fewer;
  int count = 0;
  std::optional<std::thread::id> ends; // the thread in which the interpreter ends
  pid_t process = getpid();            // a fork has none of them
};

// Never destroyed, since threads may come to it until the process has ended; and not on the heap, which may have no
// room when the interpreter's lock has been given back already.
Others& others() {
  alignas(Others) static std::byte memory[sizeof(Others)];
  static Others* const all = new (memory) Others;
  return *all;
}

[[noreturn]] void stand_still() {
  for (;;)
    pause();
}

} // namespace

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {
  Others& all = others();
  std::unique_lock lock(all.guard);
  if (all.ends && *all.ends != std::this_thread::get_id()) {
    lock.unlock();
    stand_still();
  }
  ++all.count;
}

Unlocked::~Unlocked() {
  Others& all = others();
  std::unique_lock lock(all.guard);
  const bool ended = all.ends && *all.ends != std::this_thread::get_id();
  if (!ended) {
    lock.unlock();
    PyEval_RestoreThread(state_); // end_other_threads() waits, so the interpreter is still there
    lock.lock();
  }
  --all.count;
  all.fewer.notify_all();
  lock.unlock();
  if (ended)
    stand_still();
}

void end_other_threads() {
  Keyboard::end_others();
  Others& all = others();
  if (all.process != getpid())
    return;
  const pybind11::gil_scoped_release unlocked;
  std::unique_lock lock(all.guard);
  all.ends = std::this_thread::get_id();
  all.fewer.wait(lock, [&] { return all.count == 0; });
}

void require_own_threads() {
  pid_t none = 0;
  if (computed_in.compare_exchange_strong(none, getpid()) || none == getpid())
    return;
  throw Error(ExitCode::run_time, "this process was forked from one in which Keeler had computed, and threads do not "
                                  "survive that; start it by multiprocessing's \"spawn\" or \"forkserver\"");
}

} // namespace keeler::python
