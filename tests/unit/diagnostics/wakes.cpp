#include <keeler/diagnostics/wakes.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

namespace wakes_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

const ShearingBox box{245.0, 200.0, 1.5, 0.0};

Wakes wakes_of(const std::vector<Patch>& patches, double wavelength) {
  return find_wakes(mean_autocorrelation(patches), wavelength);
}

} // namespace

TEST_CASE("pitch and spacing of a density wave, at any shear offset, trailing and leading") {
  struct Case {
    int across, along;
    double offset;
  };
  for (const Case& c :
       {Case{4, 1, 0.0}, Case{4, 1, 63.7}, Case{3, 1, 150.3}, Case{4, 2, 30.1}, Case{5, -1, 120.0}, Case{4, 0, 77.7}}) {
    CAPTURE(c.across);
    CAPTURE(c.along);
    CAPTURE(c.offset);
    const test::Wave wave(box, c.offset, c.across, c.along);
    const Wakes wakes = wakes_of({test::scattered(box, c.offset, 9600, 1, wave)}, 61.0);
    REQUIRE(wakes.pitch_degrees);
    REQUIRE(wakes.spacing);
    CHECK(std::fabs(*wakes.pitch_degrees - wave.pitch * 180.0 / pi) < 2.0);
    CHECK(*wakes.spacing == doctest::Approx(wave.radial_length).epsilon(0.05));
    CHECK(wakes.amplitude > 0.1); // ½ (0.4/0.5)² = 0.32 along the crest, less over the disc of all directions
  }
}

TEST_CASE("snapshots at different offsets add up") {
  // The wave turns from one offset to the next; it is drawn at the two offsets nearest to pitch 20°.
  const test::Wave first(box, 10.0, 4, 1), second(box, 14.0, 4, 1);
  const Wakes wakes =
      wakes_of({test::scattered(box, 10.0, 5000, 1, first), test::scattered(box, 14.0, 5000, 2, second)}, 61.0);
  REQUIRE(wakes.pitch_degrees);
  CHECK(std::fabs(*wakes.pitch_degrees - 0.5 * (first.pitch + second.pitch) * 180.0 / pi) < 2.0);
  REQUIRE(wakes.spacing);
  CHECK(*wakes.spacing == doctest::Approx(0.5 * (first.radial_length + second.radial_length)).epsilon(0.05));
}

TEST_CASE("particles at random show no wakes") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Wakes wakes = wakes_of({test::uniform(box, 20.0 * static_cast<double>(seed), 9600, seed)}, 61.0);
    CHECK(!wakes.pitch_degrees);
    CHECK(!wakes.spacing);
    CHECK(std::fabs(wakes.amplitude) < 0.02);
  }
}

TEST_CASE("a wavelength that the map does not resolve gives no wakes") {
  const Wakes wakes = wakes_of({test::scattered(box, 0.0, 2000, 1, test::Wave(box, 0.0, 4, 1))}, 5.0);
  CHECK(!wakes.pitch_degrees);
  CHECK(!wakes.spacing);
  CHECK(wakes.profile.empty());
}

TEST_CASE("a single wake has a direction but no spacing") {
  const test::Wave wave(box, 0.0, 1, 0); // one crest per box: its neighbour is farther than half a box
  const auto crest = [&](double x, double y) { return std::exp(8.0 * (wave(x, y) - 0.9)); };
  const Wakes wakes = wakes_of({test::scattered(box, 0.0, 5000, 1, crest)}, 61.0);
  REQUIRE(wakes.pitch_degrees);
  CHECK(std::fabs(*wakes.pitch_degrees) < 2.0);
  CHECK(!wakes.spacing);
}

TEST_CASE("a ridge that bends has an inner and an outer pitch") {
  // A crest that leans by 30° within 0.4 λ_cr along y and by 10° beyond, 6 m wide.
  const double lambda = 61.0;
  AutocorrelationMap map;
  map.reach = 90;
  map.rows = 150;
  map.spacing_x = map.spacing_y = 2.0;
  map.noise = 1e-3;
  for (int i = -map.reach; i <= map.reach; ++i)
    for (int j = -map.rows / 2; j < map.rows / 2; ++j) {
      const double dy = 2.0 * j, bend = std::clamp(dy, -0.4 * lambda, 0.4 * lambda);
      const double crest = -bend * std::tan(pi / 6.0) - (dy - bend) * std::tan(pi / 18.0);
      map.values.push_back(std::exp(-0.5 * std::pow((2.0 * i - crest) / 6.0, 2) - std::fabs(dy) / lambda));
    }
  const Wakes wakes = find_wakes(map, lambda);
  REQUIRE(wakes.inner_pitch_degrees);
  REQUIRE(wakes.outer_pitch_degrees);
  CHECK(std::fabs(*wakes.inner_pitch_degrees - 30.0) < 1.5);
  CHECK(std::fabs(*wakes.outer_pitch_degrees - 10.0) < 1.5);
  CHECK(*wakes.pitch_degrees < *wakes.inner_pitch_degrees);
  CHECK(*wakes.pitch_degrees > *wakes.outer_pitch_degrees);

  map.noise = 0.15; // the crest, e^(−Δy/λ_cr), falls below the noise at 0.8 λ_cr
  const Wakes noisy = find_wakes(map, lambda);
  CHECK(noisy.inner_pitch_degrees);
  CHECK(!noisy.outer_pitch_degrees);
}

} // namespace wakes_test
