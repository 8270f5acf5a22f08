// Self-gravity wakes in the demo's A-ring patch: trailing at 15–30°, spaced by about λ_cr (Salo 1995; Daisaka, Tanaka &
// Ida 2001), from the mean autocorrelation of the third orbit. Three seeds; minutes of processor time.
#include "physics/scenes.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/diagnostics/analysis.hpp>

#include <doctest/doctest.h>

using namespace keeler;

TEST_CASE("wakes of the A-ring example have the pitch and the spacing of the literature") {
  for (const int seed : {1, 2, 3}) {
    const Scene scene =
        load_scene(KEELER_EXAMPLES "/a-ring-wakes/scene.toml", {fmt::format("particles.seed={}", seed)});
    Simulation simulation(scene, initial_patch(scene));
    std::vector<Patch> patches;
    while (simulation.state().step < scene.time.end_step) {
      simulation.advance();
      if (simulation.state().step % scene.output.snapshot_every == 0 && simulation.orbits() >= 2.0 - 1e-9)
        patches.push_back(simulation.patch());
    }
    const Analysis a = analyze(patches);
    REQUIRE(a.wake_pitch_degrees.has_value());
    REQUIRE(a.wake_spacing_m.has_value());
    MESSAGE("seed " << seed << ": pitch " << *a.wake_pitch_degrees << " degrees, spacing "
                    << *a.wake_spacing_m / a.critical_wavelength_m << " lambda_cr, Q " << a.toomre_q);
    CHECK(*a.wake_pitch_degrees > 15.0);
    CHECK(*a.wake_pitch_degrees < 30.0);
    CHECK(*a.wake_spacing_m > 0.5 * a.critical_wavelength_m);
    CHECK(*a.wake_spacing_m < 1.5 * a.critical_wavelength_m);
    CHECK(largest_overlap(simulation.patch()).depth < 1e-9);
  }
}
