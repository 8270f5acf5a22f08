#include <keeler/diagnostics/transmission.hpp>

#include "states.hpp"

#include <keeler/core/threads.hpp>
#include <keeler/light/photometry.hpp>
#include <keeler/light/tracer.hpp>

#include <doctest/doctest.h>

#include <numeric>

namespace transmission_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

constexpr double degree = pi / 180.0;

// Brute force: true if a sphere or one of its images is closer to the ray than its radius.
bool blocked_in_space(const Patch& patch, const LineOfSight& sight, const Vec3& place, int most) {
  const Vec3 d(std::cos(sight.elevation) * std::cos(sight.azimuth), std::cos(sight.elevation) * std::sin(sight.azimuth),
               std::sin(sight.elevation));
  for (std::size_t k = 0; k < patch.size(); ++k)
    for (int nx = -most; nx <= most; ++nx)
      for (int ny = -most; ny <= most; ++ny) {
        const Vec3 to = patch.positions[k] + patch.box.displacement({nx, ny}, patch.offset) - place;
        if ((to - to.dot(d) * d).norm() < patch.radii[k])
          return true;
      }
  return false;
}

} // namespace

TEST_CASE("each ray is blocked as by all spheres and images in space") {
  const ShearingBox box{24.0, 17.0, 1.5, 0.0};
  for (const double offset : {0.0, 4.3, 15.0})
    for (const double elevation : {3.45, 10.0, 28.0, 60.0, 90.0})
      for (const double azimuth : {0.0, 33.0, 90.0, 110.0, 200.0, -45.0}) {
        CAPTURE(offset);
        CAPTURE(elevation);
        CAPTURE(azimuth);
        Patch patch = test::uniform(box, offset, 12, 3);
        for (std::size_t k = 0; k < patch.size(); ++k)
          patch.radii[k] = 0.1 + 0.1 * static_cast<double>(k % 4);
        patch.positions[3] += box.displacement({1, -1}, offset); // outside the cell by its eccentricity
        const LineOfSight sight{elevation * degree, azimuth * degree};
        const RayLattice rays(box, 400, 5.0);
        const std::vector<std::uint8_t> blocked = rays.blocked(patch, sight);
        std::size_t wrong = 0;
        for (std::size_t ray = 0; ray < rays.size(); ++ray)
          wrong += (blocked[ray] != 0) != blocked_in_space(patch, sight, rays.position(ray), 4) ? 1 : 0;
        CHECK(wrong == 0);
      }
}

TEST_CASE("rays marked by shadows are those that Embree finds blocked") {
  if (!light::can_trace())
    return;
  const ShearingBox sheared{240.0, 170.0, 1.5, 0.0};
  Patch patch = test::uniform(sheared, 43.0, 1500, 3);
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.radii[k] = 0.3 + 0.3 * static_cast<double>(k % 4);
  const light::Tracer tracer(patch);
  for (const double elevation : {4.0, 20.0, 65.0, 90.0})
    for (const double azimuth : {0.0, 111.0, -40.0}) {
      const LineOfSight sight{elevation * degree, azimuth * degree};
      const Vec3 to_star = light::Bearing{sight.elevation, sight.azimuth}.direction();
      const RayLattice rays(sheared, 20000, 20.0);
      const std::vector<std::uint8_t> marked = rays.blocked(patch, sight);
      std::size_t different = 0;
      for (std::size_t ray = 0; ray < rays.size(); ++ray) {
        const Vec3 start = rays.position(ray) + tracer.cell().bottom() / to_star.z() * to_star;
        different += tracer.blocked(start, to_star) != (marked[ray] != 0) ? 1 : 0;
      }
      CAPTURE(elevation);
      CAPTURE(azimuth);
      CHECK(different <= 2); // of limbs within the rounding of single precision
    }
}

TEST_CASE("a lattice has one ray a cell and whole footprints") {
  const ShearingBox box{24.0, 17.0, 1.5, 0.0};
  const RayLattice rays(box, 1000, 5.0);
  CHECK(rays.footprints() == 5 * 3);
  CHECK(rays.size() == rays.columns() * rays.rows());
  CHECK(rays.rays_per_footprint() * rays.footprints() == rays.size());
  CHECK(static_cast<double>(rays.size()) == doctest::Approx(1000.0).epsilon(0.15));
  CHECK(rays.footprint_x() == doctest::Approx(4.8));
  for (std::size_t ray = 0; ray < rays.size(); ++ray) {
    const double column = (rays.position(ray).x() + 12.0) / 24.0 * static_cast<double>(rays.columns());
    const double row = (rays.position(ray).y() + 8.5) / 17.0 * static_cast<double>(rays.rows());
    CHECK(static_cast<std::size_t>(column) == ray / rays.rows());
    CHECK(static_cast<std::size_t>(row) == ray % rays.rows());
  }

  // A sphere that blocks the rays of one footprint alone.
  Patch patch = test::uniform(box, 0.0, 1, 1);
  patch.positions[0] = Vec3(-12.0 + 1.5 * 4.8, -8.5 + 2.5 * 17.0 / 3.0, 0.0);
  patch.radii[0] = 2.0;
  const std::vector<double> transmissions = rays.transmissions(rays.blocked(patch, {pi / 2.0, 0.0}));
  for (std::size_t f = 0; f < transmissions.size(); ++f)
    CHECK(transmissions[f] ==
          (f == 1 * 3 + 2 ? doctest::Approx(1.0 - pi * 4.0 / (4.8 * 17.0 / 3.0)).epsilon(0.1) : doctest::Approx(1.0)));
}

TEST_CASE("a dilute layer at random passes exp(-tau / sin B) at five elevations") {
  // N spheres at random, each with a shadow of the area a on A, pass (1 − a/A)^N on average. Four states scatter by
  // less than 0.5 % about it.
  const ShearingBox box{400.0, 400.0, 1.5, 0.0};
  const RayLattice rays(box, 400000, 10.0);
  for (const double elevation : {5.0, 12.0, 30.0, 55.0, 90.0}) {
    const double sine = std::sin(elevation * degree);
    double mean = 0.0;
    constexpr int states = 4;
    for (std::uint64_t seed = 1; seed <= states; ++seed) {
      const Patch patch = test::uniform(box, 57.0 * static_cast<double>(seed), 5000, seed); // τ = 0.098
      mean += ray_mean(rays.blocked(patch, {elevation * degree, 0.7})).transmission / states;
    }
    const double tau = 5000.0 * pi / box.area();
    CAPTURE(elevation);
    CHECK(mean == doctest::Approx(std::exp(-tau / sine)).epsilon(0.015));
    CHECK(mean == doctest::Approx(std::pow(1.0 - pi / sine / box.area(), 5000.0)).epsilon(0.015));
  }
}

TEST_CASE("a cylinder along the orbit passes what its width leaves, at five elevations and any azimuth") {
  // One row of spheres along y, so near to each other that they make a cylinder to 1e-4 of its radius.
  const ShearingBox box{20.0, 30.0, 1.5, 0.0};
  Patch patch = test::uniform(box, 0.0, 1500, 1);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    patch.positions[k] = Vec3(1.3, 0.02 * static_cast<double>(k) - 15.0, 0.4);
    patch.radii[k] = 1.0;
  }
  const RayLattice rays(box, 200000, 5.0);
  for (const double elevation : {4.0, 10.0, 25.0, 50.0, 90.0})
    for (const double azimuth : {0.0, 30.0, 70.0, 85.0}) {
      // Across the cylinder the ray rises by sin B for every cos B cos φ along x.
      const double across = std::cos(elevation * degree) * std::cos(azimuth * degree);
      const double sine = std::sin(elevation * degree) / std::hypot(std::sin(elevation * degree), across);
      const double expected = std::max(0.0, 1.0 - 2.0 / (box.size_x * sine));
      const RayMean mean = ray_mean(rays.blocked(patch, {elevation * degree, azimuth * degree}));
      CAPTURE(elevation);
      CAPTURE(azimuth);
      CHECK(std::fabs(mean.transmission - expected) < 4.0 * mean.error + 2e-4);
    }
}

TEST_CASE("the error is that of lattices with other seeds") {
  const ShearingBox box{60.0, 40.0, 1.5, 0.0};
  const Patch patch = test::uniform(box, 9.0, 300, 1);
  double sum = 0.0, squares = 0.0, error = 0.0;
  constexpr int seeds = 60;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const RayLattice rays(box, 4000, 10.0, seed);
    const RayMean mean = ray_mean(rays.blocked(patch, {0.5, 1.0}));
    sum += mean.transmission / seeds;
    squares += mean.transmission * mean.transmission / seeds;
    error += mean.error / seeds;
  }
  const double spread = std::sqrt((squares - sum * sum) * seeds / (seeds - 1));
  CHECK(error > 0.8 * spread); // the spread of 60 is known to 9 %
  CHECK(error < 1.5 * spread);
}

TEST_CASE("the bits do not depend on the threads") {
  const ShearingBox box{60.0, 40.0, 1.5, 0.0};
  const Patch patch = test::uniform(box, 9.0, 300, 1);
  set_threads(1);
  const RayLattice one(box, 4000, 10.0);
  const auto alone = one.blocked(patch, {0.1, 1.0});
  set_threads(2);
  const RayLattice two(box, 4000, 10.0);
  CHECK(two.blocked(patch, {0.1, 1.0}) == alone);
  CHECK(two.position(77) == one.position(77));
}

} // namespace transmission_test
