#include <keeler/bench/step.hpp>

#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>
#include <keeler/initial_conditions/initial.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

namespace step_test {

using namespace keeler;
using namespace keeler::bench;

namespace {

const std::string small_scene = R"(
[planet]
preset = "saturn-a-ring"
[box]
size = [40, 40]
[particles]
count = 300
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 2e-3
end = 1.0
[gravity]
opening_angle = 0.5
kick_every = 3
)";

// Stores the initial state of a scene as a snapshot.
struct StoredState {
  test::TemporaryFolder folder;
  std::string file = (folder / "start.hdf").string();

  explicit StoredState(const std::string& text) {
    const Scene scene = parse_scene(text, "test");
    io::write_snapshot(file, initial_patch(scene), {scene.resolved, {}});
  }

  StepBenchSettings settings(int repeats) const {
    StepBenchSettings settings;
    settings.from = file;
    settings.repeats = repeats;
    return settings;
  }
};

StepBench bench_on_threads(int count, const StepBenchSettings& settings) {
  const int before = threads();
  set_threads(count);
  const StepBench bench = bench_step(settings);
  set_threads(before);
  return bench;
}

} // namespace

TEST_CASE("the bench times a snapshot with the scene that it holds") {
  const StoredState stored(small_scene);
  const StepBench bench = bench_on_threads(1, stored.settings(2));
  const TimedSteps& t = bench.timed;
  CHECK(t.count == 300);
  CHECK(bench.step_orbits == 2e-3);
  CHECK(bench.choice.text == "opening_angle 0.5");
  CHECK(bench.choice.settings.kick_every == 3);
  CHECK(t.steps == 102);                                                // whole kick intervals
  CHECK(bench.dispersion_r_omega == doctest::Approx(2.0).epsilon(0.2)); // of the start

  CHECK(t.ns_per_particle_step > 0.0);
  for (const double part :
       {t.split.drift, t.split.advance, t.split.gravity, t.split.kick, t.drift_split.build, t.drift_split.reject,
        t.drift_split.solve, t.drift_split.events, t.yardsticks.line_ns, t.yardsticks.pair_ns})
    CHECK(part > 0.0);
  CHECK(t.contacts >= t.collisions);
  CHECK(t.collisions > 0);
  CHECK(t.lists_made > 0);
  CHECK(t.survivors > 0);
  CHECK(t.per_particle_step(t.contacts) == static_cast<double>(t.contacts) / (300.0 * 102 * 2));
  CHECK(t.per_contact(5.0) * static_cast<double>(t.contacts) == doctest::Approx(5.0 * 300 * 102 * 2));
  CHECK(t.speedup.step == 1.0);
}

TEST_CASE("solver and kick interval of a snapshot's scene can be replaced") {
  const StoredState stored(small_scene);
  StepBenchSettings settings = stored.settings(1);
  settings.kick_every = 7;
  settings.solver = "fft";
  const StepBench bench = bench_on_threads(1, settings);
  CHECK(bench.choice.solver == "fft");
  CHECK(bench.choice.settings.kick_every == 7);
  CHECK(bench.choice.settings.mesh_cut == 0.0); // as in a run: derived from the masses
  CHECK(bench.timed.steps == 105);
}

TEST_CASE("on two threads every part has its speedup, and the steps are the same") {
  const StoredState stored(small_scene);
  const TimedSteps one = bench_on_threads(1, stored.settings(1)).timed;
  const TimedSteps two = bench_on_threads(2, stored.settings(1)).timed;
  for (const double gain :
       {two.speedup.step, two.speedup.drift, two.speedup.events, two.speedup.gravity, two.speedup.pair})
    CHECK((gain > 0.0 && gain != 1.0));
  CHECK(one.contacts > 0);
  CHECK(two.contacts == one.contacts);
  CHECK(two.survivors == one.survivors);
}

TEST_CASE("a snapshot without gravity is refused") {
  const StoredState stored(small_scene.substr(0, small_scene.find("[gravity]")));
  CHECK_THROWS_WITH_AS(bench_step(stored.settings(1)), doctest::Contains("has no [gravity]"), UsageError);
}

TEST_CASE("settings of gravity are named after what they do") {
  GravitySettings settings;
  CHECK(choice_of(settings, 1000).text == "opening_angle 0.6");
  settings.images = {2, false};
  CHECK(choice_of(settings, 1000).text == "opening_angle 0.6, 2 rings of images alone");
  settings.solver = GravitySettings::Solver::automatic;
  CHECK(choice_of(settings, 1000).solver == "fft");
  CHECK(choice_of(settings, 1000).text == "force_error 0.002");
  CHECK(choice_of(settings, 10).solver == "direct");
  settings.solver = GravitySettings::Solver::mesh;
  CHECK(choice_of(settings, 1000).text == "mesh_spacing 1.6");
}

} // namespace step_test
