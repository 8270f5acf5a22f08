#include <keeler/statistics/scatter.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

namespace scatter_test {

using namespace keeler;
using namespace keeler::statistics;

TEST_CASE("mean and deviation") {
  const Scatter s = scatter_of({1.0, 2.0, 6.0});
  CHECK(s.count == 3);
  CHECK(s.mean == doctest::Approx(3.0).epsilon(1e-15));
  CHECK(s.deviation == doctest::Approx(std::sqrt(7.0)).epsilon(1e-15)); // (4 + 1 + 9) / 2
  CHECK(std::isnan(scatter_of({1.0}).deviation));
  CHECK(std::isnan(scatter_of({}).mean));
}

TEST_CASE("the interval of a mean is Student's") {
  CHECK(mean_bound({3, 10.0, 1.0}) == doctest::Approx(4.303 / std::sqrt(3.0)).epsilon(1e-12));
  CHECK(mean_bound({2, 10.0, 1.0}) == doctest::Approx(12.706 / std::sqrt(2.0)).epsilon(1e-12));
  CHECK(std::isnan(mean_bound({1, 10.0, std::nan("")})));
}

TEST_CASE("a difference beyond scatter") {
  // Two samples of three with deviations 1 and 1: t of four degrees of freedom, 2.776 √(2/3).
  const Scatter first{3, 10.0, 1.0};
  const MeanDifference d = mean_difference(first, {3, 12.0, 1.0});
  CHECK(d.difference == doctest::Approx(2.0).epsilon(1e-15));
  CHECK(d.bound == doctest::Approx(2.776 * std::sqrt(2.0 / 3.0)).epsilon(1e-12));
  CHECK(d.within());
  CHECK_FALSE(mean_difference(first, {3, 7.0, 1.0}).within());
  CHECK_FALSE(mean_difference(first, {1, 10.0, std::nan("")}).known());
}

TEST_CASE("equal samples differ beyond the bound once in twenty") {
  for (const std::size_t size : {std::size_t{2}, std::size_t{3}, std::size_t{6}}) {
    int beyond = 0;
    constexpr int trials = 20000;
    RandomStream random(5, RandomPurpose::sample, size);
    const auto draw = [&] {
      std::vector<double> values(size);
      for (double& value : values)
        value = random.normal();
      return scatter_of(values);
    };
    for (int k = 0; k < trials; ++k) {
      const Scatter first = draw();
      beyond += !mean_difference(first, draw()).within();
    }
    CHECK(beyond == doctest::Approx(0.05 * trials).epsilon(0.1)); // √(19 / 20000) = 0.03: three deviations
  }
}

} // namespace scatter_test
