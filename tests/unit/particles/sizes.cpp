#include <keeler/particles/sizes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace keeler;

TEST_CASE("drawn radii have the moments of the law and depend on the seed alone") {
  for (const double q : {1.0, 2.9, 3.0, 4.0}) {
    const SizeLaw law = power_sizes(q, 0.5, 5.0);
    const std::vector<double> radii = draw_radii(law, 20000, 4);
    CHECK(radii == draw_radii(law, 20000, 4));
    CHECK(radii != draw_radii(law, 20000, 5));
    for (const int k : {1, 2, 3}) {
      double sum = 0.0;
      for (const double r : radii) {
        CHECK((r >= 0.5 && r <= 5.0));
        sum += std::pow(r, k);
      }
      CHECK(sum / 20000 == doctest::Approx(law.mean_power(k)).epsilon(2e-3)); // stratified: far below 1/sqrt(N)
    }
  }
}

TEST_CASE("equal sizes are exactly equal, listed sizes are used in turn") {
  const SizeLaw equal = equal_sizes(1.5);
  for (const double r : draw_radii(equal, 10, 1))
    CHECK(r == 1.5);
  const SizeLaw listed = listed_sizes({1.0, 2.0});
  double sum = 0.0;
  for (const double r : draw_radii(listed, 100, 1))
    sum += r;
  CHECK(sum == 150.0);
  CHECK(listed.largest == 2.0);
}

TEST_CASE("of tabulated sizes each has its number, and its share of any other number") {
  const SizeLaw law = tabulated_sizes({{30.0, 1}, {1.0, 19989}, {2.0, 10}});
  CHECK(law.smallest == 1.0);
  CHECK(law.largest == 30.0);
  CHECK(law.mean_power(2) == doctest::Approx((900.0 + 19989.0 + 40.0) / 20000.0).epsilon(1e-12));
  const auto number_of = [&](double radius, std::size_t count, std::uint64_t seed) {
    const std::vector<double> radii = draw_radii(law, count, seed);
    return std::count(radii.begin(), radii.end(), radius);
  };
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const std::size_t count : {19998, 20000, 20003})
      CHECK(number_of(30.0, count, seed) == 1);
    CHECK(number_of(2.0, 20000, seed) == 10);
    CHECK(number_of(30.0, 80000, seed) == 4);
    CHECK(number_of(2.0, 10000, seed) == 5);
  }
}
