#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>
#include <vector>

namespace threads_test {

using namespace keeler;

TEST_CASE("sums are bitwise equal for any number of threads") {
  const auto term = [](std::size_t k) { return std::sin(static_cast<double>(k)) * 1e3; };
  set_threads(1);
  const double one = ordered_sum(100003, term);
  for (const int count : {2, 3, 8}) {
    set_threads(count);
    CHECK(ordered_sum(100003, term) == one);
  }
  CHECK(ordered_sum(0, term) == 0.0);
}

TEST_CASE("several sums in one pass equal separate sums") {
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
  set_threads(1);
}

TEST_CASE("the maximum equals that of a plain loop, and NaN propagates") {
  for (const std::size_t count : {0, 1, 1023, 1024, 5000}) {
    std::vector<double> values;
    for (std::size_t k = 0; k < count; ++k)
      values.push_back(std::fabs(std::sin(static_cast<double>(3 * k + 1))));
    const auto term = [&](std::size_t k) { return values[k]; };
    const double most = count ? *std::max_element(values.begin(), values.end()) : 0.0;
    for (const int number : {1, 2, 5}) {
      set_threads(number);
      CHECK(largest_of(count, term) == most);
      for (const std::size_t k : {std::size_t{0}, count / 2, count - 1})
        if (k < count) {
          const double before = std::exchange(values[k], NAN);
          CHECK(std::isnan(largest_of(count, term)));
          values[k] = before;
        }
    }
  }
  set_threads(1);
}

TEST_CASE("an exception in a loop reaches its caller from any thread, and the next loop is complete") {
  constexpr std::size_t count = 100000;
  for (const int number : {1, 2, 5}) {
    set_threads(number);
    for (const std::size_t bad : {std::size_t{0}, count / 2, count - 1}) {
      const auto body = [&](std::size_t k) {
        if (k == bad)
          throw std::bad_alloc();
      };
      CHECK_THROWS_AS(parallel_for(count, body), std::bad_alloc);
    }
    CHECK_THROWS_AS(parallel_for(count, [](std::size_t) { throw UsageError("each of them"); }), UsageError);
    CHECK(ordered_sum(count, [](std::size_t) { return 1.0; }) == static_cast<double>(count));
  }
  set_threads(1);
}

TEST_CASE("absurd numbers of threads are refused") {
  CHECK_THROWS_AS(set_threads(max_threads + 1), UsageError);
  CHECK(threads() == 1);
}

} // namespace threads_test
