#include <keeler/states/settling.hpp>

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace keeler;

namespace {

constexpr std::size_t window = 16;
constexpr SettleCriterion criterion;

// Ten orbits of samples whose amplitude is f(orbits).
template<class Amplitude> std::vector<WakeSample> history(const Amplitude& f) {
  std::vector<WakeSample> samples;
  for (int k = 1; k <= 160; ++k)
    samples.push_back({k / 16.0, f(k / 16.0), true});
  return samples;
}

// When a history counts as settled for the first time, in orbits; none: never.
std::optional<double> settles_at(const std::vector<WakeSample>& samples) {
  for (std::size_t n = 1; n <= samples.size(); ++n) {
    const auto settling = compare_windows(std::span(samples).first(n), window);
    if (settling && settled(*settling, criterion))
      return samples[n - 1].orbits;
  }
  return std::nullopt;
}

// Wakes that grow and saturate, wandering like those of the A-ring example: 20 % from sample to sample and 15 % within
// half an orbit.
double wandering(double orbits, std::uint64_t seed) {
  RandomStream noise(seed, RandomPurpose::position, static_cast<std::uint64_t>(std::lround(16.0 * orbits)));
  const double slow = std::sin(4.0 * 3.14159265 * orbits + static_cast<double>(seed));
  return 0.9 / (1.0 + std::exp(-4.0 * (orbits - 1.2))) * (1.0 + 0.15 * slow + 0.2 * noise.normal());
}

} // namespace

TEST_CASE("windows are compared from the second one on, by their means") {
  const std::vector<WakeSample> samples = {
      {0.1, 9.0, false}, {0.2, 1.0, true}, {0.3, 2.0, false}, {0.4, 3.0, true}, {0.5, 5.0, true}};
  CHECK_FALSE(compare_windows(std::span(samples).first(3), 2));
  const auto s = compare_windows(samples, 2);
  REQUIRE(s);
  CHECK(s->amplitude == 4.0);
  CHECK(s->before == 1.5);
  CHECK(s->change == 0.625);
  CHECK(s->deviation == 0.25);
  CHECK(s->standing);
  CHECK_FALSE(compare_windows(std::span(samples).first(4), 2)->standing); // one of the last two does not stand out
}

TEST_CASE("a constant amplitude has settled after two windows, a growing one never") {
  CHECK(settles_at(history([](double) { return 0.5; })) == 2.0);
  // e-folding in five orbits changes a mean over one orbit by 1 − e^−0.2 = 18 %
  CHECK_FALSE(settles_at(history([](double t) { return 0.1 * std::exp(t / 5.0); })));
  CHECK_FALSE(settles_at(history([](double t) { return std::exp(-t / 5.0); }))); // nor one that falls, by 22 %
}

TEST_CASE("wakes that wander about a settled amplitude settle, near it, and not while they still grow") {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto samples = history([&](double t) { return wandering(t, seed); });
    const auto at = settles_at(samples);
    REQUIRE(at);
    CHECK(*at > 2.4); // the window before the last begins when growth is over, at 1.5
    CHECK(*at < 4.0);
    const auto end = static_cast<std::size_t>(std::lround(*at * 16.0));
    // the standard error of a mean of 16 draws of 20 % is 5 %: four of them
    CHECK(compare_windows(std::span(samples).first(end), window)->amplitude == doctest::Approx(0.9).epsilon(0.2));
  }
}

TEST_CASE("no state is taken while the amplitude is far from its mean") {
  // 0.8 for most of an orbit and then 1.6 for a quarter of it, always the same: settled, but not at every moment
  const auto at = settles_at(history([](double t) { return std::fmod(t - 1.0 / 16.0, 1.0) < 0.745 ? 0.8 : 1.6; }));
  CHECK(at == 2.0 + 1.0 / 16.0); // orbit 2 ends in the peak, 60 % above the mean
}

TEST_CASE("without wakes nothing settles, however constant it is") {
  auto samples = history([](double) { return 0.01; });
  for (WakeSample& sample : samples)
    sample.standing = false;
  CHECK_FALSE(settles_at(samples));
  CHECK_FALSE(settles_at(history([](double) { return 0.0; })));
}
