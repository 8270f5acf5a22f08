#include <keeler/core/interrupt.hpp>

#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

namespace interrupt_test {

using namespace keeler;

TEST_CASE("a parallel loop ends soon after its flag is raised, and only within the scope of Interruptible") {
  constexpr std::size_t count = 100000, chunk = 64;
  for (const int number : {1, 3}) {
    set_threads(number);
    std::atomic<bool> flag = false;
    std::atomic<std::size_t> done = 0;
    const auto work = [&] {
      parallel_for(
          count,
          [&](std::size_t) {
            if (++done == 1000)
              flag = true;
          },
          chunk);
    };
    {
      const Interruptible scope(flag);
      CHECK_THROWS_AS(work(), Interrupted);
      CHECK(interrupted());
    }
    CHECK(done >= 1000);
    CHECK(done <= 1000 + (static_cast<std::size_t>(number) + 1) * chunk); // what each thread has at hand
    CHECK_FALSE(interrupted());
    done = 1001;
    CHECK_NOTHROW(work());
    CHECK(done == count + 1001);
  }
  set_threads(1);
}

TEST_CASE("the innermost scope determines the flag") {
  const std::atomic<bool> set = true, clear = false;
  const Interruptible outer(set);
  {
    const Interruptible inner(clear);
    CHECK_NOTHROW(throw_if_interrupted());
  }
  CHECK_THROWS_AS(throw_if_interrupted(), Interrupted);
}

} // namespace interrupt_test
