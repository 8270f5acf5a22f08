#include "computing.hpp"

#include <keeler/core/error.hpp>

#include <atomic>
#include <cassert>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <new>
#include <optional>
#include <thread>

#include <unistd.h>

namespace keeler::python {
namespace {

std::atomic<pid_t> computing_process = 0; // the process that started the OpenMP threads

// The threads that have released the interpreter's lock, and whether they may take it again.
struct UnlockedThreads {
  std::mutex guard;
  std::condition_variable fewer;
  int count = 0;
  std::optional<std::thread::id> ends; // the thread that ends the interpreter
  pid_t process = getpid();            // a forked process has none of these threads
};

// Never destroyed, since threads may use it until the process ends. Not on the heap: an allocation could fail after the
// interpreter's lock is released.
UnlockedThreads& unlocked_threads() {
  alignas(UnlockedThreads) static std::byte memory[sizeof(UnlockedThreads)];
  static UnlockedThreads* const all = new (memory) UnlockedThreads;
  return *all;
}

[[noreturn]] void block_forever() {
  for (;;)
    pause();
}

} // namespace

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {
  UnlockedThreads& all = unlocked_threads();
  std::unique_lock lock(all.guard);
  if (all.ends && *all.ends != std::this_thread::get_id()) {
    lock.unlock();
    block_forever();
  }
  ++all.count;
}

Unlocked::~Unlocked() {
  UnlockedThreads& all = unlocked_threads();
  std::unique_lock lock(all.guard);
  const bool ended = all.ends && *all.ends != std::this_thread::get_id();
  if (!ended) {
    lock.unlock();
    PyEval_RestoreThread(state_); // end_other_threads() waits, so the interpreter still exists
    lock.lock();
  }
  assert(all.count > 0);
  --all.count;
  all.fewer.notify_all();
  lock.unlock();
  if (ended)
    block_forever();
}

void end_other_threads() {
  UnlockedThreads& all = unlocked_threads();
  if (all.process != getpid()) {
    Keyboard::end_others();
    return;
  }
  const pybind11::gil_scoped_release unlocked;
  std::unique_lock lock(all.guard);
  all.ends = std::this_thread::get_id(); // before the others are interrupted, so that all of these block
  Keyboard::end_others();
  all.fewer.wait(lock, [&] { return all.count == 0; });
}

void require_own_threads() {
  pid_t none = 0;
  if (computing_process.compare_exchange_strong(none, getpid()) || none == getpid())
    return;
  throw Error(ExitCode::run_time, "this process was forked from one in which Keeler had computed, and a fork has no "
                                  "threads; start it by multiprocessing's \"spawn\" or \"forkserver\"");
}

} // namespace keeler::python
