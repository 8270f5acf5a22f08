#include <keeler/statistics/median.hpp>

#include <doctest/doctest.h>

namespace median_test {

using namespace keeler;
using namespace keeler::statistics;

TEST_CASE("medians") {
  CHECK(median({3.0, 1.0, 2.0}) == 2.0);
  CHECK(median({4.0, 1.0, 2.0, 3.0}) == 2.5);
}

} // namespace median_test
