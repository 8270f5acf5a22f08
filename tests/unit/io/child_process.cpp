#include "child_process.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/large_blocks.hpp>

#include <doctest/doctest.h>

#include <csignal>
#include <cstdlib>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace child_process_test {

using namespace keeler;
using namespace keeler::io;

namespace {

constexpr ChildLimits small = {.memory = std::size_t{1} << 28, .cpu_s = 1, .wall_s = 1};

double apart(const std::function<double()>& read, const ChildLimits& limits = small) {
  return read_after_trial("read it", limits, read);
}

bool has_children() {
  return waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

volatile double sink = 0.0; // work that no compiler leaves out

} // namespace

TEST_CASE("what succeeds in a child is done here") {
  int calls = 0; // of this process
  CHECK(apart([&] {
          ++calls;
          return 0.1;
        }) == 0.1);
  CHECK(calls == 1);
  CHECK(!has_children());
}

TEST_CASE("an error in the child is rethrown here") {
  CHECK_THROWS_WITH_AS(apart([]() -> double { throw UsageError("do this"); }), "do this", UsageError);
  CHECK_THROWS_WITH_AS(apart([]() -> double { throw IoError("cannot do that"); }), "cannot do that", IoError);
}

TEST_CASE("a crash of the child is an error of one line here") {
  CHECK_THROWS_WITH_AS(apart([]() -> double { std::abort(); }), doctest::Contains("cannot read it: the library breaks"),
                       IoError);
  CHECK_THROWS_WITH_AS(apart([]() -> double { _exit(0); }), doctest::Contains("breaks on it"), IoError);
  CHECK_THROWS_WITH_AS(apart([]() -> double {
                         std::raise(SIGSEGV);
                         return 0.0;
                       }),
                       doctest::Contains("breaks on it"), IoError);
  CHECK(!has_children());
}

TEST_CASE("a child that does not end is killed") {
  SUBCASE("it computes") {
    CHECK_THROWS_WITH_AS(apart(
                             []() -> double {
                               for (;;)
                                 sink = sink + 1.0;
                             },
                             {.memory = small.memory, .cpu_s = 1, .wall_s = 60}),
                         doctest::Contains("cannot read it: reading it does not come to an end"), IoError);
  }
  SUBCASE("it waits") {
    CHECK_THROWS_WITH_AS(apart([]() -> double {
                           for (;;)
                             pause();
                         }),
                         doctest::Contains("cannot read it: reading it does not come to an end"), IoError);
  }
  CHECK(!has_children());
}

#ifndef KEELER_SANITIZED // sanitizers take terabytes of addresses
TEST_CASE("a child cannot exceed its memory limit") {
  const auto eat = []() -> double {
    std::vector<double> meal(small.memory, 1.0); // eight times as many bytes
    sink = meal.back();
    return sink;
  };
  for (void (*const policy)() : {stop_reusing_large_blocks, reuse_large_blocks}) {
    policy();
    CHECK_THROWS_WITH_AS(apart(eat), doctest::Contains("cannot read it: it takes more memory than there is"), IoError);
  }
  stop_reusing_large_blocks();
}
#endif

TEST_CASE("waiting for a child can be interrupted") {
  const std::atomic<bool> stop = true;
  const Interruptible work(stop);
  CHECK_THROWS_AS(apart([] { return 1.0; }), Interrupted);
  CHECK(!has_children());
}

} // namespace child_process_test
