#include "settling.hpp"

#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <functional>
#include <vector>

namespace settling_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

constexpr std::size_t orbit = 20; // samples
constexpr SettleCriterion criterion;

// The sampled values of a history at a time in orbits.
struct Course {
  std::function<double(double)> viscosity = [](double) { return 2.0; };
  std::function<double(double)> wavelength = [](double) { return 50.0; };
  std::function<double(double)> radial_wavelength = [](double) { return 60.0; };
  std::function<double(double)> contrast = [](double) { return 0.6; };
  std::function<bool(double)> standing = [](double) { return true; };
};

diagnostics::WakePower waves_of(double wavelength, double radial_wavelength, double contrast, bool standing) {
  diagnostics::WakePower waves;
  waves.snapshots = 1;
  waves.power = 0.5 * contrast * contrast;
  waves.bins[0] = {waves.power, waves.power * two_pi / wavelength, waves.power * two_pi / radial_wavelength};
  waves.cosine = waves.power;
  waves.noise_squares = waves.power * waves.power * (standing ? 1e-4 : 1.0);
  return waves;
}

std::vector<SettleSample> history(const Course& course, double end = criterion.max_orbits) {
  std::vector<SettleSample> samples;
  double work = 7.0; // from an arbitrary zero
  for (int k = 1; k <= static_cast<int>(orbit * end); ++k) {
    const double t = k / static_cast<double>(orbit);
    work += course.viscosity(t) * two_pi / static_cast<double>(orbit);
    samples.push_back(
        {t, work, waves_of(course.wavelength(t), course.radial_wavelength(t), course.contrast(t), course.standing(t))});
  }
  return samples;
}

// Returns the first time at which a history is settled, or its end if never.
struct First {
  double orbits = HUGE_VAL;
  Settling settling;
};

First first_settled(const Course& course) {
  const std::vector<SettleSample> samples = history(course);
  for (std::size_t n = 1; n <= samples.size(); ++n) {
    const auto settling = compare_windows(std::span(samples).first(n), orbit, criterion);
    if (settling && settled(*settling, criterion))
      return {samples[n - 1].orbits, *settling};
  }
  return {};
}

double noise(double orbits, std::uint64_t seed) {
  RandomStream stream(seed, RandomPurpose::position, static_cast<std::uint64_t>(std::lround(orbit * orbits)));
  return stream.normal();
}

} // namespace

TEST_CASE("two windows of whole orbits are compared, as long as fit after the first orbit that counts") {
  Course course;
  course.viscosity = [](double t) { return t < 5.01 ? 99.0 : t < 7.01 ? 2.0 : 3.0; };
  course.wavelength = [](double t) { return t < 5.01 ? 9.0 : t < 7.01 ? 40.0 : 60.0; };
  const std::vector<SettleSample> samples = history(course);
  const auto at = [&](double orbits) {
    return compare_windows(std::span(samples).first(static_cast<std::size_t>(std::lround(orbits * orbit))), orbit,
                           criterion);
  };
  CHECK_FALSE(at(8.95));
  const auto s = at(9.0);
  REQUIRE(s);
  CHECK(s->window_orbits == 2);
  CHECK(s->viscosity.before.value == doctest::Approx(2.0));
  CHECK(s->viscosity.last.value == doctest::Approx(3.0));
  CHECK(s->viscosity.mean() == doctest::Approx(2.5));
  CHECK(s->viscosity.change() == doctest::Approx(0.4));
  CHECK(s->viscosity.error() < 1e-9);
  CHECK(s->viscosity.tolerance == criterion.viscosity.change);
  CHECK(s->wavelength.change() == doctest::Approx(0.4));
  CHECK(s->radial_wavelength.change() == doctest::Approx(0.0));
  CHECK(s->standing == 1.0);
  CHECK(s->contrast == doctest::Approx(0.6));
  CHECK(s->deviation < 1e-9);
  CHECK(at(10.95)->window_orbits == 2);
  CHECK(at(11.0)->window_orbits == 3);
}

TEST_CASE("the tolerance is two errors of the difference, or the least one") {
  const WindowMeans wide = compare({1.0, 0.06}, {3.0, 0.08}, criterion.viscosity, 2.0);
  CHECK(wide.tolerance == doctest::Approx(0.1));
  CHECK(wide.error() == doctest::Approx(0.04));
  CHECK(compare({1.0, 0.3}, {3.0, 0.4}, criterion.viscosity, 2.0).tolerance == doctest::Approx(0.5));
}

TEST_CASE("a steady history has settled at the least number of orbits, a drifting one never") {
  CHECK(first_settled({}).orbits == doctest::Approx(criterion.min_orbits()));
  // e-folding in ten orbits changes a mean over two orbits by 20 %
  CHECK(first_settled({.viscosity = [](double t) { return std::exp(t / 10.0); }}).orbits == HUGE_VAL);
  CHECK(first_settled({.viscosity = [](double t) { return std::exp(-t / 10.0); }}).orbits == HUGE_VAL);
  CHECK(first_settled({.wavelength = [](double t) { return 50.0 * std::exp(t / 20.0); }}).orbits == HUGE_VAL);
  CHECK(first_settled({.radial_wavelength = [](double t) { return 50.0 * std::exp(-t / 20.0); }}).orbits == HUGE_VAL);
}

TEST_CASE("a plateau in the overshoot of orbits 2 to 5 is not taken for the settled state") {
  const First first = first_settled({.viscosity = [](double t) { return t < 2.0 ? t : t < 5.01 ? 2.6 : 2.0; }});
  CHECK(first.orbits == doctest::Approx(9.0));
  CHECK(first.settling.viscosity.mean() == doctest::Approx(2.0));
  // A decay until orbit 8 delays settling: windows must grow until it has little weight.
  const First late = first_settled({.viscosity = [](double t) { return t < 8.0 ? 4.0 - 0.25 * t : 2.0; }});
  CHECK(late.orbits > 10.0);
  CHECK(late.orbits < 14.0);
}

TEST_CASE("boxes that scatter more are averaged over longer windows, and their means are right within errors") {
  double shortest = 0.0, longest = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto scattering = [&](double share) {
      return first_settled({.viscosity = [=](double t) { return 2.0 * (1.0 + share * noise(t, seed)); }});
    };
    const First little = scattering(0.1), much = scattering(0.7);
    REQUIRE(little.orbits < HUGE_VAL);
    REQUIRE(much.orbits < HUGE_VAL);
    shortest += little.orbits / 20.0;
    longest += much.orbits / 20.0;
    CHECK(little.settling.viscosity.mean() == doctest::Approx(2.0).epsilon(0.05));
    CHECK(much.settling.viscosity.mean() == doctest::Approx(2.0).epsilon(0.3));
    CHECK(much.settling.viscosity.error() <= criterion.viscosity.error);
  }
  CHECK(shortest < 9.5);
  CHECK(longest > shortest + 0.5);
}

TEST_CASE("no state is taken while its contrast is far from the mean") {
  const First first = first_settled({.contrast = [](double t) { return t > 8.5 && t < 9.12 ? 0.8 : 0.6; }});
  CHECK(first.orbits == doctest::Approx(9.15));
}

TEST_CASE("without wakes nothing settles, however constant it is; weak ones need stand out in half of the samples") {
  CHECK(first_settled({.standing = [](double) { return false; }}).orbits == HUGE_VAL);
  CHECK(first_settled({.standing = [](double t) { return std::fmod(t + 0.01, 0.2) < 0.06; }}).orbits == HUGE_VAL);
  CHECK(first_settled({.standing = [](double t) { return std::fmod(t + 0.01, 0.2) < 0.12; }}).orbits < HUGE_VAL);
}

} // namespace settling_test
