#include <keeler/diagnostics/radial_profile.hpp>

#include "states.hpp"

#include <keeler/diagnostics/dispersion.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <doctest/doctest.h>

namespace radial_profile_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {
const ShearingBox box{60.0, 40.0, 1.5, 0.0};
}

TEST_CASE("each bin has its particles") {
  Patch patch = test::uniform(box, 7.0, 200, 1);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    patch.masses[k] = 1.0 + static_cast<double>(k % 3);
    patch.radii[k] = 0.5 + 0.1 * static_cast<double>(k % 3);
    patch.velocities[k] += Vec3(0.1 * static_cast<double>(k % 5), -0.2, 0.3 * static_cast<double>(k % 2));
  }
  const std::vector<RadialBin> profile = radial_profile(patch, 6);
  REQUIRE(profile.size() == 6);
  std::size_t all = 0;
  for (std::size_t b = 0; b < 6; ++b) {
    const double low = -30.0 + 10.0 * static_cast<double>(b);
    CHECK(profile[b].x == doctest::Approx(low + 5.0));
    double mass = 0.0, squares = 0.0, momentum = 0.0, energy = 0.0;
    std::size_t count = 0;
    for (std::size_t k = 0; k < patch.size(); ++k)
      if (const double x = patch.positions[k].x(); x >= low && x < low + 10.0) {
        ++count;
        mass += patch.masses[k];
        squares += patch.radii[k] * patch.radii[k];
        momentum += patch.masses[k] * patch.velocities[k].x();
        energy += patch.masses[k] * patch.velocities[k].x() * patch.velocities[k].x();
      }
    all += count;
    CHECK(profile[b].count == count);
    CHECK(profile[b].surface_density == doctest::Approx(mass / 400.0).epsilon(1e-12));
    CHECK(profile[b].optical_depth == doctest::Approx(pi * squares / 400.0).epsilon(1e-12));
    CHECK(profile[b].velocity.x() == doctest::Approx(momentum / mass).epsilon(1e-12));
    CHECK(profile[b].velocity.y() == doctest::Approx(-0.2).epsilon(1e-12));
    CHECK(profile[b].dispersion.x() ==
          doctest::Approx(std::sqrt(energy / mass - std::pow(momentum / mass, 2))).epsilon(1e-9));
    CHECK(profile[b].dispersion.y() < 1e-12);
  }
  CHECK(all == 200);
}

TEST_CASE("one bin is the patch, an image counts as its particle, an empty bin has no motion") {
  Patch patch = test::uniform(box, 7.0, 200, 1);
  patch.velocities[5] += Vec3(3.0, 2.0, 1.0);
  const auto whole = radial_profile(patch, 1);
  CHECK(whole[0].surface_density == doctest::Approx(surface_density(patch)).epsilon(1e-12));
  CHECK((whole[0].dispersion - velocity_dispersion(patch)).norm() < 1e-12);
  const auto before = radial_profile(patch, 12);
  patch.positions[5] += box.displacement({-1, 0}, patch.offset);
  patch.velocities[5].y() += box.shear * box.size_x;
  const auto after = radial_profile(patch, 12);
  for (std::size_t b = 0; b < 12; ++b) {
    CHECK(after[b].count == before[b].count);
    CHECK((after[b].velocity - before[b].velocity).norm() < 1e-12);
  }
  const auto lone = radial_profile(test::uniform(box, 0.0, 1, 1), 4);
  std::size_t empty = 0;
  for (const RadialBin& bin : lone)
    empty += bin.count == 0 && bin.dispersion == Vec3::Zero() && bin.velocity == Vec3::Zero() ? 1 : 0;
  CHECK(empty == 3);
}

} // namespace radial_profile_test
