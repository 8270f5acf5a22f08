#include <keeler/statistics/time_series.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace time_series_test {

using namespace keeler;
using namespace keeler::statistics;

namespace {

// Noise whose neighbours are correlated by `memory`: its mean over n values has the variance (1 + a)/(1 − a)/n of that
// of white noise, for long series.
std::vector<double> correlated(std::size_t count, double memory, std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::velocity, 0);
  std::vector<double> values;
  double value = random.normal();
  for (std::size_t k = 0; k < count; ++k) {
    values.push_back(value);
    value = memory * value + std::sqrt(1.0 - memory * memory) * random.normal();
  }
  return values;
}

} // namespace

TEST_CASE("the error of a mean by blocks is that of known correlated noise") {
  for (const double memory : {0.0, 0.5, 0.9}) {
    constexpr int series = 200;
    constexpr std::size_t count = 2048;
    double squares = 0.0, errors = 0.0;
    for (int k = 0; k < series; ++k) {
      const Estimate mean = block_mean(correlated(count, memory, static_cast<std::uint64_t>(k) + 1));
      squares += mean.value * mean.value / series;
      errors += mean.error / series;
    }
    const double exact = std::sqrt((1.0 + memory) / (1.0 - memory) / count);
    CHECK(std::sqrt(squares) == doctest::Approx(exact).epsilon(0.15)); // 200 means: 5 %, three times
    CHECK(errors == doctest::Approx(exact).epsilon(0.12));
  }
}

TEST_CASE("the statistical inefficiency of correlated noise is (1 + a)/(1 - a)") {
  for (const double memory : {0.0, 0.5, 0.9}) {
    double sum = 0.0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed)
      sum += statistical_inefficiency(correlated(4096, memory, seed)) / 40.0;
    CHECK(sum == doctest::Approx((1.0 + memory) / (1.0 - memory)).epsilon(0.15));
  }
}

TEST_CASE("what begins with a transient is steady after it, and noise is from its first tenth on") {
  std::size_t early = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<double> values = correlated(1500, 0.7, seed);
    early += steady_start(values) < 300 ? 1 : 0;
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] += 30.0 * std::exp(-static_cast<double>(k) / 50.0);
    const std::size_t start = steady_start(values);
    CHECK(start >= 100); // the transient has decayed below 4 standard deviations
    CHECK(start < 700);  // by chance
    CHECK_FALSE(is_steady(std::span(values).first(200)));
  }
  CHECK(early >= 17);
}

TEST_CASE("noise that remembers long is called steady nearly always, and a drift of five widths never") {
  int steady = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::vector<double> values = correlated(1500, 0.95, seed);
    steady += is_steady(values) ? 1 : 0;
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] += 5.0 * static_cast<double>(k) / 1500.0;
    CHECK_FALSE(is_steady(values));
  }
  CHECK(steady >= 39); // two halves three errors apart: 0.3 % of them, and errors are estimates
}

TEST_CASE("few values, or equal ones") {
  const double three[] = {1.0, 2.0, 3.0};
  CHECK(block_mean(three).value == 2.0);
  CHECK(std::isnan(block_mean(three).error));
  const double equal[] = {2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0};
  CHECK(block_mean(equal).error == 0.0);
  CHECK(statistical_inefficiency(equal) == 1.0);
  CHECK(steady_start(equal) == 0);
  CHECK(is_steady(equal));
}

} // namespace time_series_test
