#include <keeler/particles/sizes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace sizes_test {

using namespace keeler;
using namespace keeler::particles;

TEST_CASE("each row of populations has its number of particles, its radius and its density") {
  const SizeLaw law = populations({{2.0, 30, 450.0}, {2.0, 50, 900.0}, {5.0, 20, 1200.0}});
  CHECK(law.listed == 3);
  const DrawnSizes sizes(law, 100, 3);
  int light = 0, heavy = 0, large = 0;
  double mass = 0.0, volume = 0.0;
  for (std::size_t k = 0; k < 100; ++k) {
    const double radius = sizes.radius(k), density = sizes.density(k);
    light += radius == 2.0 && density == 450.0;
    heavy += radius == 2.0 && density == 900.0;
    large += radius == 5.0 && density == 1200.0;
    volume += std::pow(radius, 3);
    mass += std::pow(radius, 3) * density;
  }
  CHECK(light == 30);
  CHECK(heavy == 50);
  CHECK(large == 20);
  CHECK(law.mean_density == doctest::Approx(mass / volume).epsilon(1e-14));
  CHECK_FALSE(DrawnSizes(equal_sizes(1.0), 100, 3).has_densities());
  const SizeLaw alike = populations({{1.0, 1, 300.0}, {1.0, 3, 600.0}}); // one radius, two densities
  const DrawnSizes of_alike(alike, 80, 1);
  int lightest = 0;
  for (std::size_t k = 0; k < 80; ++k)
    lightest += of_alike.density(k) == 300.0;
  CHECK(lightest == 20);
}

TEST_CASE("drawn radii have the moments of the law and depend only on the seed") {
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

TEST_CASE("a list with as many radii as particles uses each exactly once") {
  std::vector<double> radii;
  for (int k = 0; k < 500; ++k)
    radii.push_back(0.1 + 1.0 / (1.0 + k));
  std::vector<double> once = draw_radii(listed_sizes(radii), radii.size(), 7),
                      thrice = draw_radii(listed_sizes(radii), 3 * radii.size(), 7);
  CHECK(once != radii); // shuffled
  std::sort(once.begin(), once.end());
  std::sort(radii.begin(), radii.end());
  CHECK(once == radii);
  std::sort(thrice.begin(), thrice.end());
  for (std::size_t k = 0; k < radii.size(); ++k)
    for (std::size_t copy = 0; copy < 3; ++copy)
      CHECK(thrice[3 * k + copy] == radii[k]);
}

TEST_CASE("tabulated sizes have their numbers, and their fractions of any other number") {
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

TEST_CASE("for any count, each size of a list is used once, by any particle with equal probability") {
  std::vector<double> numbers;
  for (std::size_t count = 1; count <= 300; ++count) {
    numbers.push_back(static_cast<double>(count));
    std::vector<double> radii = draw_radii(listed_sizes(numbers), count, 11);
    std::sort(radii.begin(), radii.end());
    CHECK(radii == numbers);
  }
  for (const std::size_t count : {2, 3, 5, 16, 17}) {
    CAPTURE(count);
    constexpr int seeds = 8000;
    std::vector<std::vector<int>> times(count, std::vector<int>(count, 0)); // particle, place in the list
    for (int seed = 0; seed < seeds; ++seed) {
      const std::vector<double> radii =
          draw_radii(listed_sizes({numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count)}), count,
                     static_cast<std::uint64_t>(seed));
      for (std::size_t k = 0; k < count; ++k)
        ++times[k][static_cast<std::size_t>(radii[k]) - 1];
    }
    const double share = 1.0 / static_cast<double>(count);
    for (const std::vector<int>& of_particle : times)
      for (const int its : of_particle) // 4.5 standard errors
        CHECK(std::fabs(its - seeds * share) < 4.5 * std::sqrt(seeds * share * (1.0 - share)));
  }
}

} // namespace sizes_test
