#include <keeler/states/clumped.hpp>

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>

#include <doctest/doctest.h>

using namespace keeler;

namespace {

// A patch of two by two wavelengths that clumps within an orbit: a second of processor time an orbit.
Scene scene(const std::vector<std::string>& overrides = {}) {
  return parse_scene(R"(
[planet]
preset = "saturn-a-ring"
[box]
size_in_wavelengths = [2, 2]
[particles]
optical_depth = 0.5
density = 450.0
sizes = { law = "equal", radius = 1.0 }
velocity_dispersion = 2.5
[gravity]
solver = "tree"
opening_angle = 0.8
kick_every = 5
[time]
step = 2e-3
end = 1.0
)",
                     "test scene", overrides);
}

} // namespace

TEST_CASE("a patch clumps until the criterion holds, the same for any number of threads") {
  std::vector<ClumpingProgress> steps;
  set_threads(2);
  const ClumpedState two = clumped_state(scene(), [&](const ClumpingProgress& p) { steps.push_back(p); });
  const Clumping& c = two.clumping;
  CHECK(settled(c.settling, c.criterion));
  CHECK(c.orbits > 2.0 * c.criterion.window_orbits - 1e-9);
  CHECK(two.patch.time_orbits == c.orbits);
  CHECK(largest_overlap(two.patch).depth < 1e-9);
  CHECK(c.sample_every_orbits == doctest::Approx(0.06)); // 1/16 orbit in kick intervals of 0.01

  CHECK(steps.size() == static_cast<std::size_t>(std::lround(c.orbits / 2e-3)));
  CHECK(steps.back().settled);
  CHECK_FALSE(steps[steps.size() - 2].settled);
  CHECK(steps.back().settling->amplitude == c.settling.amplitude);

  set_threads(1);
  const ClumpedState one = clumped_state(scene());
  CHECK(one.patch.positions == two.patch.positions);
  CHECK(one.patch.velocities == two.patch.velocities);
  CHECK(clumping_numbers(one.clumping) == clumping_numbers(c));
}

TEST_CASE("what cannot clump is refused in words, a stop leaves nothing") {
  Scene light = scene();
  light.gravity.reset();
  CHECK_THROWS_AS(clumped_state(light), UsageError);
  CHECK_THROWS_AS(clumped_state(scene({"particles.count=5"})), UsageError); // too few to see a wake

  std::atomic<bool> stop = false;
  const Interruptible by_stop(stop);
  CHECK_THROWS_AS(clumped_state(scene(), [&](const ClumpingProgress& p) { stop = p.orbits > 0.0199; }), Interrupted);
}

TEST_CASE("a patch too light to clump is given up, not written") {
  // Q = 2.1 at c_x = 2 r Ω, which collisions alone keep up: no wakes stand out (Salo 1995)
  const Scene light = scene({"particles.density=110", "box.size=[60,60]", "gravity.kick_every=10"});
  try {
    clumped_state(light);
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::run_time);
    CHECK(std::string(error.what()).find("no wakes stand") != std::string::npos);
  }
}
