#include <keeler/particles/sizes.hpp>

#include <doctest/doctest.h>

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
