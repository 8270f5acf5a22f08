// The two examples of clumped states: their wakes settle, at an amplitude within the range of the runs in
// docs/dev/diagnostics.md, and trail. Minutes of processor time.
#include "physics/scenes.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/diagnostics/analysis.hpp>
#include <keeler/states/clumped.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

struct Case {
  const char* example;
  double least_amplitude, largest_amplitude; // of the mean over the last orbit
};

void clump(const Case& expected) {
  const Scene scene = load_scene(fmt::format("{}/{}/scene.toml", KEELER_EXAMPLES, expected.example));
  const ClumpedState state = clumped_state(scene);
  const Clumping& c = state.clumping;
  const Analysis a = analyze(std::span(&state.patch, 1));
  MESSAGE(std::string(expected.example) << ": " << c.orbits << " orbits, mean amplitude " << c.settling.amplitude
                                        << ", the state's " << a.wake_amplitude << ", Q " << a.toomre_q);
  CHECK(c.settling.amplitude > expected.least_amplitude);
  CHECK(c.settling.amplitude < expected.largest_amplitude);
  CHECK(a.wake_amplitude == c.history.back().amplitude); // what is recorded is what `keeler analyze` measures
  REQUIRE(a.wake_pitch_degrees.has_value());
  CHECK(*a.wake_pitch_degrees > 0.0); // trailing; single states of three seeds had 8–50°
  CHECK(*a.wake_pitch_degrees < 60.0);
  CHECK(largest_overlap(state.patch).depth < 1e-9);
}

} // namespace

// The means over an orbit of three seeds were 0.73–1.17 once settled, those of the power law 0.45–0.65.
TEST_CASE("equal particles clump until their wakes have settled") {
  clump({"clumped-equal", 0.6, 1.3});
}

TEST_CASE("a power law of sizes clumps until its wakes have settled") {
  clump({"clumped-power-law", 0.35, 0.8});
}
