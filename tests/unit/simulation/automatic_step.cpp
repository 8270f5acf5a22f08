// The automatic step: its decisions, and equal runs for any number of threads and restarts.
#include "step_control.hpp"

#include "draws.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/simulation/simulation.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstring>

namespace automatic_step_test {

using namespace keeler;
using namespace keeler::simulation;

namespace {

// A small patch that clumps.
Scene clumping_scene() {
  return parse_scene(R"(
planet.preset = "saturn-a-ring"
box.size = [60.0, 60.0]
particles = { optical_depth = 0.5, density = 900.0, sizes = { law = "equal", radius = 1.0 } }
gravity.solver = "fft"
time = { step = "auto", end = 1.0 }
)",
                     "test scene");
}

bool same_bits(const SimulationState& a, const SimulationState& b) {
  const auto same = [](const auto& left, const auto& right) {
    return left.size() == right.size() && std::memcmp(left.data(), right.data(), left.size() * sizeof(left[0])) == 0;
  };
  return a.step == b.step && a.step_length == b.step_length && a.control.kick == b.control.kick &&
         a.control.steps == b.control.steps && same(a.particles.bodies, b.particles.bodies) &&
         same(a.particles.ids, b.particles.ids);
}

void run_until(Simulation& simulation, double orbits) {
  while (simulation.orbits() < orbits - 1e-12)
    simulation.advance();
}

// The decision after `ticks` in which each of `count` particles had `rate` contacts per tick, a fraction of them
// unresolved.
StepControl decided(const StepControl& last, double rate, double unresolved, std::int64_t ticks = decision_ticks) {
  constexpr std::size_t count = 10'000;
  CollisionTally tally;
  tally.fast = last.contacts + static_cast<std::uint64_t>(0.5 * rate * count * static_cast<double>(ticks));
  tally.unresolved =
      last.unresolved + static_cast<std::uint64_t>(unresolved * static_cast<double>(tally.fast - last.contacts));
  return decide_step(last, tally, count, last.decided_at + ticks);
}

} // namespace

TEST_CASE("the step follows the contacts of a particle, within its bounds, and does not swing") {
  StepControl control{.step = 4, .kick = 64};
  CHECK(decided(control, 0.01, 0.01).step == 16); // 0.16 of a contact in it, 0.32 in the next longer one
  CHECK(decided(control, 1e-6, 0.01).step == 64);
  CHECK(decided(control, 0.2, 0.01).step == 2);
  CHECK(decided(control, 50.0, 0.01).step == 1);
  control.kick = 8;
  CHECK(decided(control, 1e-6, 0.01).step == 8); // never longer than the kick interval
  for (double rate = 1e-3; rate < 1.0; rate *= 1.1) {
    const StepControl once = decided({.step = 4, .kick = 64}, rate, 0.01), twice = decided(once, rate, 0.01);
    CHECK(once.step == twice.step);
  }
}

TEST_CASE("the kick interval follows the share of contacts that kicks make") {
  const StepControl control{.step = 1, .kick = 16};
  CHECK(decided(control, 0.05, 0.05).kick == 16);
  CHECK(decided(control, 0.05, 0.2).kick == 8);
  CHECK(decided(control, 0.05, 0.001).kick == 32);
  CHECK(decided({.step = 1, .kick = 64}, 0.05, 0.001).kick == 64);
  CHECK(decided({.step = 1, .kick = 1}, 0.05, 0.9).kick == 1);
  CHECK(decided(control, 1e-6, 0.9).kick == 16); // too few contacts to tell
}

TEST_CASE("a run whose step changes has the same bits on any threads and over a restart") {
  const Scene scene = clumping_scene();
  const Patch start = initial_patch(scene);
  const double end = test::sanitized ? 0.25 : 1.0; // orbits
  const int before = threads();
  set_threads(1);
  Simulation whole(scene, start);
  std::int64_t shortest = 64, longest = 1;
  while (whole.orbits() < end) {
    whole.advance();
    CHECK(whole.state().control.fits(whole.state().step));
    shortest = std::min(shortest, whole.state().control.step);
    longest = std::max(longest, whole.state().control.step);
  }
  CHECK(shortest < longest); // it did change
  for (const int count : {2, 3}) {
    set_threads(count);
    Simulation other(scene, start);
    run_until(other, end);
    CHECK(same_bits(whole.state(), other.state()));
  }
  Simulation first(scene, start);
  run_until(first, 0.5 * end);
  Simulation second(scene, first.state());
  run_until(second, end);
  CHECK(same_bits(whole.state(), second.state()));
  set_threads(before);
}

// Without forces and contacts a change of the step must not show.
TEST_CASE("who meets nobody rides the same epicycle under an automatic step") {
  const std::string text = R"(
planet = { orbital_frequency = 2e-4, epicyclic_ratio = 0.98, vertical_ratio = 1.3 }
box.size = [1e5, 1e5]
particles = { count = 20, density = 900.0, sizes = { law = "equal", radius = 1e-3 } }
time = { step = )";
  const Scene automatic = parse_scene(text + "\"auto\", end = 3.0 }", "test scene"),
              fixed = parse_scene(text + "0.03125, end = 3.0 }", "test scene");
  const Patch start = initial_patch(automatic);
  Simulation one(automatic, start), other(fixed, start);
  run_until(one, 3.0);
  run_until(other, 3.0);
  CHECK(one.state().control.step == 64); // no particle needs a shorter one
  const Patch a = one.patch(), b = other.patch();
  REQUIRE(one.orbits() == other.orbits());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::size_t same = std::find(b.ids.begin(), b.ids.end(), a.ids[k]) - b.ids.begin();
    CHECK((a.positions[k] - b.positions[same]).norm() < 1e-9 * 1e5);
    CHECK((a.velocities[k] - b.velocities[same]).norm() < 1e-12 * 1e5);
  }
}

// Two spheres that fall together from a small gap touch more slowly than a kick of their gravity moves them.
TEST_CASE("contacts that a kick of the pair's own gravity makes are counted as unresolved") {
  for (const double interval : {1e-3, 16e-3}) {
    const Scene scene = parse_scene(fmt::format(R"(
planet.orbital_frequency = 1.3e-4
box.size = [100.0, 100.0]
particles = {{ count = 2, density = 900.0, sizes = {{ law = "equal", radius = 1.0 }} }}
collisions.restitution = {{ law = "constant", value = 0.0 }}
gravity = {{ solver = "direct", kick_every = {} }}
time = {{ step = 1e-3, end = 1.0 }}
)",
                                                std::lround(1e3 * interval)),
                                    "test scene");
    Patch patch = initial_patch(scene);
    patch.positions = {Vec3(0.0, 0.0, 0.0), Vec3(0.0, 2.0 + 1e-6, 0.0)};
    patch.velocities = {Vec3::Zero(), Vec3::Zero()};
    Simulation simulation(scene, patch);
    run_until(simulation, 0.032);
    const CollisionTally& tally = simulation.state().collisions;
    REQUIRE(tally.fast + tally.slow > 0);
    CHECK(tally.unresolved == tally.fast + tally.slow);
  }
}

TEST_CASE("an automatic step is a word, and sets the kick interval itself") {
  CHECK(clumping_scene().time.automatic);
  CHECK(clumping_scene().time.step * 4096 == 1.0);
  const auto with = [](const std::string& time, const std::string& gravity) {
    return parse_scene("planet.preset = \"saturn-a-ring\"\nbox.size = [60.0, 60.0]\nparticles = { optical_depth = 0.5, "
                       "density = 900.0, sizes = { law = \"equal\", radius = 1.0 } }\n" +
                           gravity + "\ntime = { " + time + ", end = 1.0 }\n",
                       "test scene");
  };
  CHECK_THROWS_WITH_AS(with("step = \"aut\"", ""), doctest::Contains("did you mean \"auto\"?"), UsageError);
  CHECK_THROWS_WITH_AS(with("step = \"auto\"", "gravity.kick_every = 5"),
                       doctest::Contains("gravity.kick_every cannot be combined with time.step = \"auto\""),
                       UsageError);
  CHECK(with("step = \"auto\"", "output.series_every = 0.02").output.series_every == 64);
}

} // namespace automatic_step_test
