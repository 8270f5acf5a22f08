#include <keeler/particles/patch.hpp>

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

namespace patch_test {

using namespace keeler;

TEST_CASE("a patch lists particles by id and converts back to elements") {
  const Frequencies f{0.99458, 1.00539};
  Particles particles;
  particles.ids = {5, 2, 9};
  particles.bodies = {
      {{1, 2, 0.3, 0.4, 0.5, 0.6}, 1.0, 10.0}, {{-3, 7, 0, 0, 0, 0}, 2.0, 80.0}, {{0, 0, 1, 1, 1, 1}, 3.0, 270.0}};
  const ShearingBox box{20, 30, f.shear(), 0.0};
  const Patch patch = make_patch(particles, box, 4.0, f, -0.01);
  CHECK(patch.ids == std::vector<std::uint64_t>{2, 5, 9});
  CHECK(patch.radii == std::vector<double>{2.0, 1.0, 3.0});
  const Particles back = particles_from(patch, 0.01);
  const Elements difference = back.bodies[1].elements - particles.bodies[0].elements;
  for (const double d : {difference.guiding_x, difference.guiding_y, difference.e_cos, difference.e_sin,
                         difference.i_sin, difference.i_cos})
    CHECK(std::fabs(d) < 1e-14);
}

TEST_CASE("an invalid patch is an error that names the particle") {
  Patch patch;
  patch.positions = {Vec3::Zero(), Vec3(3.0, 0.0, 0.0)};
  patch.velocities = {Vec3::Zero(), Vec3::Zero()};
  patch.radii = {1.0, 1.0};
  patch.masses = {1.0, 1.0};
  patch.ids = {4, 7};
  CHECK_NOTHROW(require_sound(patch));
  for (double* broken : {&patch.radii[1], &patch.masses[1], &patch.positions[1].x(), &patch.velocities[1].z()}) {
    const double kept = *broken;
    *broken = std::nan("");
    CHECK_THROWS_WITH_AS(require_sound(patch), doctest::Contains("particle 7"), InvariantError);
    *broken = kept;
  }
  patch.radii[0] = -1.0;
  CHECK_THROWS_AS(require_sound(patch), InvariantError);
}

} // namespace patch_test
