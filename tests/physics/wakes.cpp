// Self-gravity wakes in the demo's A-ring patch: trailing at 15–30°, spaced by about λ_cr (Salo 1995; Daisaka, Tanaka &
// Ida 2001), over the third orbit, for each of three seeds. The box holds two or three wakes, so the spacing of a
// single run scatters: ten runs gave 0.8–1.4 λ_cr. Minutes of processor time.
#include "physics/scenes.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/diagnostics/analysis.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

std::vector<Patch> third_orbit(int seed) {
  const Scene scene = load_scene(KEELER_EXAMPLES "/a-ring-wakes/scene.toml", {fmt::format("particles.seed={}", seed)});
  Simulation simulation(scene, initial_patch(scene));
  std::vector<Patch> patches;
  while (simulation.state().step < scene.time.end_step) {
    simulation.advance();
    if (simulation.state().step % scene.output.snapshot_every == 0 && simulation.orbits() >= 2.0 - 1e-9)
      patches.push_back(simulation.patch());
  }
  return patches;
}

} // namespace

TEST_CASE("wakes of the A-ring example have the pitch and the spacing of the literature") {
  constexpr int seeds = 3;
  double spacing = 0.0; // mean over the seeds, λ_cr
  for (int seed = 1; seed <= seeds; ++seed) {
    const std::vector<Patch> patches = third_orbit(seed);
    const Analysis a = analyze(patches);
    REQUIRE(a.wake_pitch_degrees.has_value());
    REQUIRE(a.wake_spacing_m.has_value());
    const double own_spacing = *a.wake_spacing_m / a.critical_wavelength_m;
    MESSAGE("seed " << seed << ": pitch " << *a.wake_pitch_degrees << " degrees, spacing " << own_spacing
                    << " lambda_cr, Q " << a.toomre_q);
    CHECK(*a.wake_pitch_degrees > 15.0);
    CHECK(*a.wake_pitch_degrees < 30.0);
    CHECK(largest_overlap(patches.back()).depth < 1e-9);
    spacing += own_spacing / seeds;
  }
  CHECK(spacing > 0.5);
  CHECK(spacing < 1.5);
}
