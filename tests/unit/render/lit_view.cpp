#include "lit_view.hpp"

#include <keeler/core/units.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace lit_view_test {

using namespace keeler;
using namespace keeler::render;

namespace {

constexpr double degree = pi / 180.0;

// A sphere of 5 m in a box of 40 × 40 m.
Patch one_sphere(const Vec3& place) {
  Patch patch;
  patch.box = {40.0, 40.0, 1.5, 0.0};
  patch.offset = 12.0;
  patch.orbital_frequency = 1.3e-4;
  patch.ids.push_back(0);
  patch.positions.push_back(place);
  patch.velocities.emplace_back(0.0, 0.0, 0.0);
  patch.radii.push_back(5.0);
  patch.masses.push_back(1.0);
  return patch;
}

LitLook look_of(const light::Bearing& observer, const light::Bearing& sun) {
  return {{observer, sun}, light::lambert_law(0.6), "lambert", 4};
}

} // namespace

TEST_CASE("a lone Lambert sphere has the brightness of its normals") {
  const LitLook look = look_of({90.0 * degree, -90.0 * degree}, {40.0 * degree, 25.0 * degree});
  const Raster view = lit_view(one_sphere({3.0, -4.0, 0.5}), look, 200, 200, 5.0);
  const Vec3 sun = look.sight.sun.direction();
  for (const Vec3& normal : {Vec3(0.0, 0.0, 1.0), Vec3(0.5, 0.2, std::sqrt(0.71)), Vec3(-0.6, 0.6, std::sqrt(0.28))}) {
    // from above, with the observer's azimuth -90 degrees, x is right and y is up
    const int i = static_cast<int>(100.0 + 5.0 * (3.0 + 5.0 * normal.x()));
    const int j = static_cast<int>(100.0 - 5.0 * (-4.0 + 5.0 * normal.y()));
    const double shown = std::pow(view.pixel(i, j).r, 2.2) * white_level(look);
    CHECK(std::fabs(shown - 0.6 * std::max(0.0, normal.dot(sun))) < 0.03); // a pixel spans 0.04 of the normal
  }
  CHECK(view.pixel(10, 10).r == 0.0);
}

TEST_CASE("directions of the patch on the page") {
  const light::Sight above{{90.0 * degree, -90.0 * degree}, {40.0 * degree, 0.0}};
  CHECK(seen_direction(Vec3::UnitX(), above)[0] == doctest::Approx(1.0));
  CHECK(seen_direction(Vec3::UnitY(), above)[1] == doctest::Approx(1.0));
  const light::Sight low{{20.0 * degree, 0.0}, {40.0 * degree, 0.0}}; // from outside: motion goes to the right
  CHECK(seen_direction(Vec3::UnitY(), low)[0] == doctest::Approx(1.0));
  CHECK(seen_direction(Vec3::UnitX(), low)[1] == doctest::Approx(-std::sin(20.0 * degree)));
  CHECK(seen_direction(Vec3::UnitZ(), low)[1] == doctest::Approx(std::cos(20.0 * degree)));
}

TEST_CASE("a shadow falls on what is behind, also across the edge of the box") {
  // The Sun is low, in the direction +x; the second sphere is 30 m behind the first one, which is 10 m away through the
  // edge.
  Patch patch = one_sphere({-15.0, 0.0, 0.0});
  patch.ids.push_back(1);
  patch.positions.emplace_back(15.0, 12.0, 0.0); // the image of (-15, 0) one box outward is at (25, -12)
  patch.velocities.emplace_back(0.0, 0.0, 0.0);
  patch.radii.push_back(5.0);
  patch.masses.push_back(1.0);
  const LitLook look = look_of({90.0 * degree, -90.0 * degree}, {1.0 * degree, 0.0});
  const auto brightness = [&](const Patch& lit) {
    const Raster view = lit_view(lit, look, 200, 200, 5.0);
    return view.pixel(100 + 5 * 18, 100 - 5 * 12).r; // the side of the second sphere that faces the Sun
  };
  const double free = brightness(patch);
  CHECK(free > 0.5);
  patch.positions[0].y() =
      24.0 - 40.0; // its image outward is at y = -28, and with a box along the orbit at 12: in front
  CHECK(brightness(patch) < 0.3 * free);
}

} // namespace lit_view_test
