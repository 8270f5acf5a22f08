#include <keeler/diagnostics/wakes.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

using namespace keeler;

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
  const test::Wave wave(box, 0.0, 1, 0); // one crest a box: its neighbour is farther than half a box
  const auto crest = [&](double x, double y) { return std::exp(8.0 * (wave(x, y) - 0.9)); };
  const Wakes wakes = wakes_of({test::scattered(box, 0.0, 5000, 1, crest)}, 61.0);
  REQUIRE(wakes.pitch_degrees);
  CHECK(std::fabs(*wakes.pitch_degrees) < 2.0);
  CHECK(!wakes.spacing);
}
