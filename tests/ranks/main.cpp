// Runs the tests on every rank; all ranks fail if one does.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "launched.hpp"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#include <sanitizer/lsan_interface.h>
#define KEELER_CHECKS_LEAKS
#endif
#endif

using namespace keeler;

namespace {
Communicator ranks;

// Excludes what MPI keeps from its start: parts of it are unloaded later and cannot be named in lsan.supp.
Communicator start() {
#ifdef KEELER_CHECKS_LEAKS
  const __lsan::ScopedDisabler not_here;
#endif
  return Communicator::launched();
}

// Returns true if memory leaked. Precondition: MPI is still loaded, so that lsan.supp can exclude what it keeps.
bool leaks() {
#ifdef KEELER_CHECKS_LEAKS
  return __lsan_do_recoverable_leak_check() != 0;
#else
  return false;
#endif
}

} // namespace

const Communicator& keeler_test::launched() {
  return ranks;
}

int main(int argc, char** argv) {
  ranks = start();
  doctest::Context context(argc, argv);
  if (!ranks.is_root())
    context.setOption("minimal", true); // prints failures only
  const bool failed = ranks.any(context.run() != 0 || leaks());
  comm::finish_ranks();
  return failed ? 1 : 0;
}
