#include <keeler/initial_conditions/clumped.hpp>

#include "draws.hpp"
#include "settling.hpp"

#include <keeler/cells/overlap.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

namespace clumped_test {

using namespace keeler;
using namespace keeler::initial_conditions;

namespace {

// A patch of two by two wavelengths that clumps within an orbit: a quarter of a second of processor time per orbit.
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

// A weaker criterion, sufficient for these tests.
SettleCriterion lenient() {
  SettleCriterion criterion;
  criterion.first_orbit = 1.0;
  criterion.min_window_orbits = 1;
  criterion.viscosity = criterion.wavelengths = {.error = 0.5, .change = 0.5};
  return criterion;
}

struct Clumped {
  ClumpedState state;
  std::vector<ClumpingProgress> steps;
};

Clumped clumped_by(const SettleCriterion& criterion) {
  set_threads(1);
  std::vector<ClumpingProgress> steps;
  ClumpedState state = clumped_state(scene(), criterion, [&](const ClumpingProgress& p) { steps.push_back(p); });
  return {std::move(state), std::move(steps)};
}

// Made once, by the first case that needs it.
const Clumped& leniently_clumped() {
  static const Clumped made = clumped_by(lenient());
  return made;
}

} // namespace

TEST_CASE("a patch clumps until the criterion holds") {
#ifdef KEELER_SANITIZED // three orbits run the same code as nine
  const Clumped& made = leniently_clumped();
#else
  const Clumped made = clumped_by({});
#endif
  const ClumpedState& state = made.state;
  const std::vector<ClumpingProgress>& steps = made.steps;
  const Clumping& c = state.clumping;
  CHECK(settled(c.settling, c.criterion));
  CHECK(c.orbits > c.criterion.min_orbits() - 1e-9);
  CHECK(c.settling.viscosity.error() <= c.criterion.viscosity.error);
  CHECK(c.settling.wavelength.change() <= c.settling.wavelength.tolerance);
  CHECK(c.settling.standing >= c.criterion.min_standing);
  CHECK(state.patch.time_orbits == c.orbits);
  CHECK(cells::largest_overlap(state.patch).depth < 1e-9);
  CHECK(c.sample_every_orbits == doctest::Approx(0.05)); // a multiple of the kick interval, 0.01

  CHECK(steps.size() == static_cast<std::size_t>(std::lround(c.orbits / 2e-3)));
  CHECK(steps.back().settled);
  CHECK_FALSE(steps[steps.size() - 2].settled);
  CHECK(steps.back().settling->contrast == c.settling.contrast);
}

TEST_CASE("a patch clumps the same for any number of threads") {
  set_threads(2);
  const ClumpedState two = clumped_state(scene(), lenient());
  const ClumpedState& one = leniently_clumped().state;
  CHECK(one.patch.positions == two.patch.positions);
  CHECK(one.patch.velocities == two.patch.velocities);
  // compared as text: unknown lengths are NaN
  CHECK(fmt::format("{}", clumping_numbers(one.clumping)) == fmt::format("{}", clumping_numbers(two.clumping)));
}

TEST_CASE("what settled is recorded in the units of files") {
  const Clumping& c = leniently_clumped().state.clumping;
  const auto numbers = clumping_numbers(c);
  const double omega = scene().planet.orbital_frequency;
  CHECK(numbers.at("loss_viscosity_m2_s") == std::vector{omega * c.settling.viscosity.last.value});
  CHECK(numbers.at("wake_wavelength_m_before") == std::vector{c.settling.wavelength.before.value});
  CHECK(numbers.at("first_orbit") == std::vector{1.0});
  CHECK(numbers.at("history_work_m2").size() == c.history.size());

  // The rate of the work over the last window is its viscosity.
  const std::vector<double>&work = numbers.at("history_work_m2"), &orbits = numbers.at("history_orbits");
  const std::size_t last = c.history.size() - 1, first = last - 20 * c.settling.window_orbits;
  CHECK(omega * (work[last] - work[first]) / (two_pi * (orbits[last] - orbits[first])) ==
        doctest::Approx(numbers.at("loss_viscosity_m2_s")[0]));
}

TEST_CASE("what cannot clump is refused in words, a stop leaves nothing") {
  Scene light = scene();
  light.gravity.reset();
  CHECK_THROWS_AS(clumped_state(light), UsageError);
  CHECK_THROWS_AS(clumped_state(scene({"particles.count=5"})), UsageError); // too few to see a wake

  SettleCriterion hasty;
  hasty.max_orbits = 8.9;
  CHECK_THROWS_AS(clumped_state(scene(), hasty), UsageError); // nothing settles before orbit 9

  std::atomic<bool> stop = false;
  const Interruptible by_stop(stop);
  CHECK_THROWS_AS(clumped_state(scene(), {}, [&](const ClumpingProgress& p) { stop = p.orbits > 0.0199; }),
                  Interrupted);
}

TEST_CASE("a patch that does not settle is given up at the limit, not written") {
  const auto refused = [](const Scene& of, const SettleCriterion& criterion, const std::string& words) {
    try {
      clumped_state(of, criterion);
      FAIL("no error");
    } catch (const Error& error) {
      CHECK(error.code() == ExitCode::run_time);
      CHECK(std::string(error.what()).find(words) != std::string::npos);
    }
  };
  // Q = 2.1 at c_x = 2 r Ω, which collisions alone maintain: no wakes (Salo 1995)
  const Scene light = scene({"particles.density=110", "box.size=[60,60]", "gravity.kick_every=10"});
  SettleCriterion criterion = lenient();
  criterion.max_orbits = criterion.min_orbits();
  if (!test::sanitized) // three orbits more
    refused(light, criterion, "no wakes in the patch");
  criterion.viscosity = {.error = 1e-9, .change = 1e-9};
  criterion.standard_errors = 0.0;
  refused(scene(), criterion, "did not settle in 3 orbits");
}

} // namespace clumped_test
