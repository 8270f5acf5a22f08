#include <keeler/diagnostics/occultation.hpp>

#include "states.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <array>

namespace occultation_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {
const ShearingBox box{240.0, 200.0, 1.5, 0.0};
}

TEST_CASE("a lattice without memory is refused before there is one") {
  for (const double footprint : {8.381903171539307e-09, 1e-300, 1e-5})
    CHECK_THROWS_WITH_AS(RayLattice(box, 1, footprint), doctest::Contains("raise --footprint"), UsageError);
  CHECK(RayLattice(box, 1, 1e300).size() == 1);
}

TEST_CASE("moments of a known distribution") {
  const std::array values{0.0, 0.0, 0.0, 1.0}; // a coin with p = 1/4
  const FlickerMoments moments = flicker_moments(values);
  CHECK(moments.variance == doctest::Approx(3.0 / 16.0));
  CHECK(*moments.skewness == doctest::Approx(0.5 / std::sqrt(3.0 / 16.0)));
  CHECK(*moments.kurtosis == doctest::Approx((1.0 - 6.0 * 3.0 / 16.0) / (3.0 / 16.0)));
  const std::array same{0.3, 0.3, 0.3};
  CHECK(flicker_moments(same).variance < 1e-30);
  CHECK(!flicker_moments(same).skewness);
}

TEST_CASE("snapshots are averaged, and the normal optical depth follows from the mean") {
  const std::vector<Patch> patches = {test::uniform(box, 0.0, 2000, 1), test::uniform(box, 50.0, 4000, 2)};
  const RayLattice rays(box, 100000, 10.0);
  const LineOfSight sight{0.4, 1.0};
  const double first = ray_mean(rays.blocked(patches[0], sight)).transmission;
  const double second = ray_mean(rays.blocked(patches[1], sight)).transmission;
  const Occultation o = occultation(patches, rays, sight);
  CHECK(*o.transmission.value == doctest::Approx(0.5 * (first + second)).epsilon(1e-12));
  CHECK(*o.transmission.scatter == doctest::Approx(std::fabs(first - second) / std::sqrt(2.0)).epsilon(1e-12));
  CHECK(*o.normal_optical_depth == doctest::Approx(-std::sin(0.4) * std::log(0.5 * (first + second))).epsilon(1e-12));
  CHECK(*o.normal_optical_depth_error > 0.0);
  CHECK(!occultation({patches.data(), 1}, rays, sight).transmission.scatter);
}

TEST_CASE("the flicker of spheres at random has the variance of their number") {
  // Showalter & Nicholson (1990): a footprint of area A behind N independent discs of area a has var T = T² τ a/A for
  // small τ, less at its edge.
  std::vector<Patch> patches;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    patches.push_back(test::uniform(box, 0.0, 1500, seed)); // τ = 0.098
  const RayLattice rays(box, 480000, 20.0);
  const Occultation o = occultation(patches, rays, {pi / 2.0, 0.0});
  const double tau = 1500.0 * pi / box.area(), t = std::exp(-tau);
  CHECK(o.flicker.variance == doctest::Approx(t * t * tau * pi / 400.0).epsilon(0.12));
  CHECK(std::fabs(*o.flicker.skewness) < 0.6);
  CHECK(std::fabs(*o.flicker.kurtosis) < 0.8);
}

TEST_CASE("nothing passes a wall; wakes are brightest along their crests") {
  Patch wall = test::uniform(box, 0.0, 1, 1);
  wall.radii[0] = 300.0;
  const RayLattice rays(box, 50000, 10.0);
  const Occultation none = occultation({&wall, 1}, rays, {0.5, 0.0});
  CHECK(*none.transmission.value == 0.0);
  CHECK(!none.normal_optical_depth);
  CHECK(!azimuthal_asymmetry(std::array{none, none}));

  const double offset = 20.0;
  const test::Wave wave(box, offset, 4, 1);
  const auto crests = [&](double x, double y) { return std::pow(wave(x, y), 4.0); };
  Patch patch = test::scattered(box, offset, 9600, 1, crests);
  for (Vec3& p : patch.positions)
    p.z() *= 6.0;
  std::vector<Occultation> looks;
  for (int azimuth = 0; azimuth < 180; azimuth += 10)
    looks.push_back(occultation({&patch, 1}, rays, {0.25, azimuth * pi / 180.0}));
  const auto asymmetry = azimuthal_asymmetry(looks);
  REQUIRE(asymmetry);
  CHECK(asymmetry->amplitude > 0.1);
  CHECK(std::fabs(asymmetry->brightest_azimuth - (pi / 2.0 + wave.pitch)) < 0.2); // trailing crests
  CHECK(!azimuthal_asymmetry(std::span(looks).first(1)));
}

} // namespace occultation_test
