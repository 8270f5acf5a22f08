#include <keeler/statistics/measured.hpp>

#include <doctest/doctest.h>

#include <array>

namespace measured_test {

using namespace keeler;
using namespace keeler::statistics;

TEST_CASE("the scatter is that of single snapshots, and needs two of them") {
  const std::array values{1.0, 2.0, 3.0};
  CHECK(*measured(1.5, values).value == 1.5);
  CHECK(*measured(1.5, values).scatter == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(!measured(1.5, std::span(values).first(1)).scatter);
  CHECK(!measured(std::nullopt, values).value);
  CHECK(!measured(std::nullopt, values).scatter);
}

TEST_CASE("directions are the same after half a turn") {
  const std::array angles{-89.0, 89.0, 90.0};
  CHECK(*measured_direction(90.0, angles).scatter == doctest::Approx(1.0).epsilon(1e-12)); // 91, 89, 90
}

} // namespace measured_test
