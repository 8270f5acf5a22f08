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

TEST_CASE("several sums in one pass are each the sum made alone") {
  struct Two {
    double sines = 0.0, squares = 0.0;
    Two& operator+=(const Two& more) {
      sines += more.sines;
      squares += more.squares;
      return *this;
    }
  };
  const auto sine = [](std::size_t k) { return std::sin(static_cast<double>(k)); };
  const auto square = [](std::size_t k) { return 1e-3 * static_cast<double>(k * k); };
  for (const int count : {1, 3}) {
    set_threads(count);
    const Two both = ordered_total<Two>(100003, [&](Two& total, std::size_t k) {
      total.sines += sine(k);
      total.squares += square(k);
    });
    CHECK(both.sines == ordered_sum(100003, sine));
    CHECK(both.squares == ordered_sum(100003, square));
  }
}
