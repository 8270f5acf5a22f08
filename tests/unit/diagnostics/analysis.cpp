#include <keeler/diagnostics/analysis.hpp>

#include "states.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/diagnostics/surface.hpp>

#include <doctest/doctest.h>

namespace analysis_test {

using namespace keeler;
using namespace keeler::diagnostics;

namespace {

const ShearingBox box{245.0, 200.0, 1.5, 0.0};

Patch with_motion(Patch patch, double speed, double time_orbits) {
  for (std::size_t k = 0; k < patch.size(); ++k)
    patch.velocities[k] += (k % 2 == 0 ? 1.0 : -1.0) * Vec3(speed, 0.5 * speed, 0.7 * speed);
  patch.time_orbits = time_orbits;
  return patch;
}

} // namespace

TEST_CASE("an analysis is the mean over the snapshots") {
  const test::Wave wave(box, 10.0, 4, 1);
  const std::vector<Patch> patches = {with_motion(test::scattered(box, 10.0, 6000, 1, wave), 2.0, 1.0),
                                      with_motion(test::scattered(box, 10.0, 6000, 2, wave), 4.0, 1.5)};
  const Analysis mean = analyze(patches);
  CHECK(mean.snapshots == 2);
  CHECK(mean.particle_count == 6000);
  CHECK(mean.time_orbits == 1.5);
  CHECK(mean.dispersion_r_omega[0] == doctest::Approx(3.0).epsilon(1e-3)); // radii of 1 m
  CHECK(mean.dispersion_m_s[2] == doctest::Approx(2.1 * 1.3175e-4).epsilon(1e-3));
  CHECK(mean.optical_depth == doctest::Approx(6000 * pi / box.area()).epsilon(1e-12));
  CHECK(mean.toomre_q == doctest::Approx(0.5 * (toomre_q(patches[0]) + toomre_q(patches[1]))).epsilon(1e-12));
  CHECK(mean.translational_viscosity_m2_s == doctest::Approx(5.0 / 1.5 * 1.3175e-4).epsilon(1e-3));
  // a common drift is no random motion
  std::vector<Patch> drifting = patches;
  for (Patch& patch : drifting)
    for (Vec3& velocity : patch.velocities)
      velocity += Vec3(-30.0, 9.0, 4.0);
  CHECK(analyze(drifting).random_energy_m2_s2 == doctest::Approx(mean.random_energy_m2_s2).epsilon(1e-9));
  CHECK(analyze(drifting).translational_viscosity_m2_s ==
        doctest::Approx(mean.translational_viscosity_m2_s).epsilon(1e-9));
  REQUIRE(mean.wake_pitch_degrees);
  CHECK(std::fabs(*mean.wake_pitch_degrees - wave.pitch * 180.0 / pi) < 2.0);
  REQUIRE(mean.wake_spacing_m);
}

TEST_CASE("a wave as long as the box is told, and Q without it is that of the rest of the motion") {
  Patch patch = with_motion(test::uniform(box, 33.0, 6000, 1), 2.0, 0.0);
  const double rest = analyze(std::span(&patch, 1)).toomre_q;
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const double x = patch.positions[k].x(), guiding_x = x + 2.0 * (patch.velocities[k].y() + box.shear * x);
    patch.velocities[k].x() += 4.0 * std::cos(two_pi * guiding_x / box.size_x);
  }
  const Analysis found = analyze(std::span(&patch, 1));
  REQUIRE(found.waves);
  CHECK(found.toomre_q == doctest::Approx(rest * std::sqrt(3.0)).epsilon(0.03)); // ⟨v_x²⟩ = 4 + 16/2
  CHECK(found.waves->toomre_q == doctest::Approx(rest).epsilon(0.03));
  CHECK(found.waves->dispersion_r_omega[0] == doctest::Approx(2.0).epsilon(0.03));
  CHECK(found.waves->dispersion_r_omega[2] == found.dispersion_r_omega[2]);
  // ½κ²e² is 4 + (2 × 1)² without the wave, of which 8 are added
  CHECK(found.waves->energy_fraction == doctest::Approx(0.5).epsilon(0.03));
}

TEST_CASE("without wakes there is no pitch, and the bits do not depend on the threads") {
  const std::vector<Patch> patches = {with_motion(test::uniform(box, 33.0, 5000, 1), 2.0, 0.0)};
  set_threads(1);
  const Analysis one = analyze(patches);
  set_threads(2);
  const Analysis two = analyze(patches);
  CHECK(!one.wake_pitch_degrees);
  CHECK(!one.wake_spacing_m);
  CHECK(one.dispersion_m_s == two.dispersion_m_s);
  CHECK(one.wake_amplitude == two.wake_amplitude);
  CHECK(one.random_energy_m2_s2 == two.random_energy_m2_s2);
}

TEST_CASE("nothing to analyze is said so") {
  CHECK_THROWS_AS(analyze({}), UsageError);
  const std::vector<Patch> empty(1);
  CHECK_THROWS_AS(analyze(empty), UsageError);
}

} // namespace analysis_test
