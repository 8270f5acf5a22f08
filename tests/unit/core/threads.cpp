#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace keeler;

TEST_CASE("sums have the same bits for any number of threads") {
  const auto term = [](std::size_t k) { return std::sin(static_cast<double>(k)) * 1e3; };
  set_threads(1);
  const double one = ordered_sum(100003, term);
  for (const int count : {2, 3, 8}) {
    set_threads(count);
    CHECK(ordered_sum(100003, term) == one);
  }
  CHECK(ordered_sum(0, term) == 0.0);
}
