#include <keeler/core/memory.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace keeler;

TEST_CASE("the peak of memory grows by what is held, and stays when it is given back") {
  constexpr std::size_t bytes = 200'000'000;
  const double before = peak_memory();
  {
    const std::vector<char> held(bytes, 1);
    CHECK(held.back() == 1);
  }
  const double after = peak_memory();
  CHECK(before > 0.0);
  CHECK(after >= bytes);
  CHECK(after >= before);
}
