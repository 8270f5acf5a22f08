#include "waiting_threads.hpp"

#include <cstdlib>

#include <unistd.h>

namespace keeler::cli {
namespace {

// Sets the policy. Returns false if the environment has one.
bool set_policy() {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT"))
    return false;
  setenv("OMP_WAIT_POLICY", "passive", 1);
  setenv("GOMP_SPINCOUNT", "6000", 1); // some 10 µs: steps have many short loops
  return true;
}

#ifdef KEELER_OPENMP_IN_PROGRAM
// The runtime is a part of this program: it reads the policy in a constructor of no priority, after this one.
[[gnu::constructor(101)]] void set_policy_first() {
  set_policy();
}
#endif

} // namespace

#ifdef KEELER_OPENMP_IN_PROGRAM
void let_threads_sleep(char** /*argv*/) {}
#else
// A shared runtime has read the policy when it was loaded, before any function of the program.
void let_threads_sleep(char** argv) {
  if (set_policy())
    execv("/proc/self/exe", argv);
}
#endif

} // namespace keeler::cli
