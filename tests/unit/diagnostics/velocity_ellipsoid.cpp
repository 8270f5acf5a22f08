#include "velocity_ellipsoid.hpp"

#include "states.hpp"

#include <keeler/diagnostics/dispersion.hpp>

#include <doctest/doctest.h>

namespace velocity_ellipsoid_test {

using namespace keeler;
using namespace keeler::diagnostics;

TEST_CASE("axes and direction of a turned ellipsoid") {
  for (const double turn : {0.0, 12.0, -35.0, 80.0}) {
    Patch patch = test::uniform({60.0, 40.0, 1.5, 0.0}, 7.0, 720, 1);
    const double angle = turn * pi / 180.0;
    for (std::size_t k = 0; k < patch.size(); ++k) { // evenly spread phases make the means exact
      const double phase = two_pi * static_cast<double>(k) / 720.0;
      const double longer = 4.0 * std::cos(phase), shorter = 1.5 * std::sin(phase);
      patch.velocities[k] +=
          Vec3(longer * std::cos(angle) - shorter * std::sin(angle) + 1.0,
               longer * std::sin(angle) + shorter * std::cos(angle) - 2.0, 2.0 * std::cos(2.0 * phase));
    }
    const VelocityMoments moments = velocity_moments(patch);
    CHECK(std::sqrt(moments.xx) == doctest::Approx(velocity_dispersion(patch).x()).epsilon(1e-12));
    const VelocityEllipsoid e = velocity_ellipsoid(moments);
    CHECK(e.second_ratio == doctest::Approx(1.5 / 4.0).epsilon(1e-10));
    CHECK(e.vertical_ratio == doctest::Approx(2.0 / 4.0).epsilon(1e-10));
    CHECK(e.vertex_deviation_degrees == doctest::Approx(turn).epsilon(1e-8));
  }
}

TEST_CASE("epicycles have c_y/c_x = κ/2 and no vertex deviation; rest has no axes") {
  const VelocityEllipsoid e = velocity_ellipsoid({2.0, 0.0, 0.5, 2.0});
  CHECK(e.second_ratio == doctest::Approx(0.5));
  CHECK(e.vertical_ratio == doctest::Approx(1.0));
  CHECK(e.vertex_deviation_degrees == 0.0);
  CHECK(velocity_ellipsoid({}).second_ratio == 0.0);
}

} // namespace velocity_ellipsoid_test
