#include <keeler/light/footprints.hpp>

#include "states.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

#include <atomic>

namespace footprints_test {

using namespace keeler;
using namespace keeler::light;

namespace {

// Rows of spheres so close along y that they make cylinders of radius 1 m, 8 m apart along x.
Patch cylinders() {
  Patch patch;
  patch.box = {8.0, 30.0, 1.5, 0.0};
  for (int k = 0; k < 1500; ++k) {
    patch.positions.emplace_back(1.3, 0.02 * k - 15.0, 0.0);
    patch.velocities.emplace_back(0.0, 0.0, 0.0);
    patch.radii.push_back(1.0);
    patch.masses.push_back(1.0);
    patch.ids.push_back(static_cast<std::uint64_t>(k));
  }
  return patch;
}

} // namespace

TEST_CASE("a footprint that crosses cylinders sees their period") {
  // From above, a sample of 2 m at a random place overlaps the cylinder of 2 m by a triangle function of its place:
  // over a period of 8 m, T = 1 − overlap/2 has the mean 3/4 and ⟨(1 − T)²⟩ = (2/8) ∫₀² (s/2)² ds = 1/6.
  const Patch patch = cylinders();
  const Bearing star{pi / 2.0, 0.0};
  FootprintTrack track;
  track.length = 2.0, track.width = 3.0, track.tracks = 1500, track.samples = 17, track.rays = 12;
  const FootprintStatistics found = footprint_statistics({&patch, 1}, {&star, 1}, track).front();
  const double variance = 1.0 / 6.0 - 1.0 / 16.0;
  CHECK(std::fabs(found.transmission.value - 0.75) < 4.0 * found.transmission.error + 1e-3);
  CHECK(found.variance.value == doctest::Approx(variance).epsilon(0.03));
  CHECK(found.variance.error < 0.03 * variance);
  REQUIRE(found.autocovariance.size() == 9);
  CHECK(found.autocovariance[4] == doctest::Approx(variance).epsilon(0.03)); // a period apart
  CHECK(found.autocovariance[8] == doctest::Approx(variance).epsilon(0.03));
  // two samples apart: both are never behind the cylinder, ⟨T T'⟩ = 1 − 2/4
  CHECK(found.autocovariance[2] == doctest::Approx(0.5 - 0.5625).epsilon(0.03));
  // ⟨(1 − T)³⟩ = (2/8) ∫₀² (s/2)³ ds = 1/8
  const double third = -(1.0 / 8.0 - 3.0 * 0.25 / 6.0 + 2.0 / 64.0);
  REQUIRE(found.skewness);
  CHECK(found.skewness->value == doctest::Approx(third * std::pow(variance, -1.5)).epsilon(0.06));
}

TEST_CASE("few rays bias no moment") {
  const Patch patch = cylinders();
  const Bearing star{pi / 2.0, 0.0};
  FootprintTrack track;
  track.length = 2.0, track.width = 3.0, track.tracks = 4000, track.samples = 8, track.rays = 4;
  const FootprintStatistics few = footprint_statistics({&patch, 1}, {&star, 1}, track).front();
  CHECK(few.variance.value == doctest::Approx(1.0 / 6.0 - 1.0 / 16.0).epsilon(0.04));
  track.rays = 40, track.tracks = 1000;
  const FootprintStatistics many = footprint_statistics({&patch, 1}, {&star, 1}, track).front();
  REQUIRE(few.skewness);
  REQUIRE(many.skewness);
  CHECK(few.skewness->value == doctest::Approx(many.skewness->value).epsilon(0.1));
  CHECK(few.kurtosis.value() == doctest::Approx(many.kurtosis.value()).epsilon(0.15).scale(1.0));
}

TEST_CASE("spheres at random have their own radius as effective radius, at any elevation") {
  for (const double elevation : {90.0, 30.0, -20.0}) {
    const Patch patch = test::random_layer(0.2, 0.02, 12000, 5, 0.3);
    const Bearing star{elevation * pi / 180.0, 0.8};
    FootprintTrack track;
    track.length = 30.0, track.width = 20.0, track.tracks = 300, track.samples = 24, track.rays = 40;
    const FootprintStatistics found = footprint_statistics({&patch, 1}, {&star, 1}, track).front();
    REQUIRE(found.effective_radius);
    CAPTURE(elevation);
    // the footprint is not much larger than a shadow at low elevations, which takes from the variance at its edge
    CHECK(*found.effective_radius == doctest::Approx(1.0).epsilon(0.12));
    CHECK(*found.optical_depth == doctest::Approx(0.2).epsilon(0.03));
    CHECK(std::fabs(found.autocovariance[6]) < 0.1 * found.variance.value);
  }
}

TEST_CASE("footprints do not depend on the threads") {
  const Patch patch = test::random_layer(0.2, 0.02, 1200, 5, 0.3);
  const Bearing star{0.5, 0.8};
  FootprintTrack track;
  track.tracks = 40;
  const int before = threads();
  set_threads(1);
  const FootprintStatistics one = footprint_statistics({&patch, 1}, {&star, 1}, track).front();
  set_threads(3);
  const FootprintStatistics three = footprint_statistics({&patch, 1}, {&star, 1}, track).front();
  set_threads(before);
  CHECK(one.variance.value == three.variance.value);
  CHECK(one.autocovariance == three.autocovariance);
}

TEST_CASE("without a variance there are no higher moments and no radius") {
  Patch patch = cylinders();
  for (double& radius : patch.radii)
    radius = 5.0; // the sky is covered
  const Bearing star{pi / 2.0, 0.0};
  FootprintTrack track;
  track.tracks = 10;
  const FootprintStatistics dark = footprint_statistics({&patch, 1}, {&star, 1}, track).front();
  CHECK(dark.transmission.value == 0.0);
  CHECK(dark.variance.value == 0.0);
  CHECK(!dark.skewness);
  CHECK(!dark.kurtosis);
  CHECK(!dark.effective_radius);
}

TEST_CASE("a stop keeps the lines of sight that are done") {
  const Patch patch = test::random_layer(0.2, 0.02, 1200, 5, 0.3);
  const std::vector<Bearing> stars(4, Bearing{0.5, 0.8});
  FootprintTrack track;
  track.tracks = 40;
  std::atomic<bool> stop = false;
  const Interruptible by_stop(stop);
  std::size_t reports = 0;
  const std::vector<FootprintStatistics> kept =
      footprint_statistics({&patch, 1}, stars, track, [&](const Progress& progress) {
        ++reports;
        stop = progress.fraction >= 0.5;
      });
  CHECK(reports == 2);
  CHECK(kept.size() == 2);
}

} // namespace footprints_test
