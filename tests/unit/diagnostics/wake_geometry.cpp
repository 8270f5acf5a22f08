#include <keeler/diagnostics/wake_geometry.hpp>

#include "states.hpp"

#include <doctest/doctest.h>

namespace wake_geometry_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {
const ShearingBox box{245.0, 200.0, 1.5, 0.0};
constexpr double lambda = 61.0;
} // namespace

TEST_CASE("inner and outer pitch of a straight wave are its pitch") {
  for (const double offset : {0.0, 63.7}) {
    const test::Wave wave(box, offset, 4, 1);
    std::vector<Patch> patches;
    for (const std::uint64_t seed : {1u, 2u, 3u})
      patches.push_back(test::scattered(box, offset, 9600, seed, wave));
    const WakeGeometry g = wake_geometry(patches, lambda);
    const double pitch = wave.pitch * 180.0 / pi;
    REQUIRE(g.inner_pitch_degrees.value);
    REQUIRE(g.outer_pitch_degrees.value);
    CHECK(std::fabs(*g.inner_pitch_degrees.value - pitch) < 3.0);
    CHECK(std::fabs(*g.outer_pitch_degrees.value - pitch) < 3.0);
    CHECK(std::fabs(*g.angle_degrees.value - pitch) < 0.5);
    CHECK(*g.angle_degrees.scatter < 0.5);
    CHECK(*g.wavelength.scatter < 0.01 * *g.wavelength.value);
  }
}

TEST_CASE("particles at random have neither sizes nor directions, and one snapshot has no scatter") {
  const std::vector<Patch> random = {test::uniform(box, 33.0, 9600, 1)};
  const WakeGeometry none = wake_geometry(random, lambda);
  CHECK(!none.wavelength.value);
  CHECK(!none.angle_degrees.value);
  CHECK(!none.inner_pitch_degrees.value);
  CHECK(!none.outer_pitch_degrees.value);
  const std::vector<Patch> one = {test::scattered(box, 0.0, 9600, 1, test::Wave(box, 0.0, 4, 1))};
  CHECK(wake_geometry(one, lambda).wavelength.value);
  CHECK(!wake_geometry(one, lambda).wavelength.scatter);
}

} // namespace wake_geometry_test
