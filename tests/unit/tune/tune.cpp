// The settings that tune chooses meet the tolerances and are the cheapest to do so; its keys are valid in a scene.
#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/tune/tune.hpp>

#include <doctest/doctest.h>

namespace tune_test {

using namespace keeler;
using namespace keeler::tune;

namespace {

const std::string text = R"(
planet.preset = "saturn-a-ring"
[box]
size = [50, 50]
[particles]
count = 400
density = 450
sizes = { law = "equal", radius = 1 }
[gravity]
solver = "tree"
[time]
end = 0.5
)";

Tuning tuned(const TuneSettings& settings) {
  return tune::tune(parse_scene(text, "s.toml"), settings);
}

} // namespace

TEST_CASE("the choices meet the tolerances, and no other measured setting that meets them is cheaper") {
  const TuneSettings settings{.force_error = 2e-3, .physics_error = 0.05, .orbits = 0.3};
  const Tuning t = tuned(settings);
  CHECK(t.particles == 400);
  CHECK(t.orbits >= 0.3);
  REQUIRE(t.meets_force_error);
  const bench::GravityBenchRow& gravity = t.gravity[t.chosen_gravity];
  CHECK(gravity.errors.rms <= margin_for_seeds * settings.force_error);
  for (const bench::GravityBenchRow& row : t.gravity)
    CHECK((row.errors.rms > margin_for_seeds * settings.force_error ||
           1.04 * row.ns_per_particle >= gravity.ns_per_particle));
  REQUIRE(t.meets_physics_error);
  const KickProbe& kicks = t.kicks[t.chosen_kicks];
  CHECK(kicks.physics_error() <= margin_for_seeds * settings.physics_error);
  for (const KickProbe& probe : t.kicks)
    CHECK((probe.physics_error() > margin_for_seeds * settings.physics_error || probe.interval <= kicks.interval));
  for (const StepProbe& probe : t.steps) {
    CHECK(probe.step * probe.drifts == doctest::Approx(kicks.interval));
    CHECK(probe.seconds > 0.0);
    CHECK(1.04 * probe.seconds > t.steps[t.chosen_step].seconds);
  }
  CHECK(t.processor_seconds > 0.0);
  CHECK(t.wall_seconds == t.processor_seconds);
  CHECK(t.chosen_threads == 1);
}

TEST_CASE("tolerances that no setting meets are reported, and the most accurate setting is chosen") {
  const Tuning t = tuned({.force_error = 1e-5, .physics_error = 1e-9, .orbits = 0.05});
  if (!t.meets_force_error)
    for (const bench::GravityBenchRow& row : t.gravity)
      CHECK(row.errors.rms >= t.gravity[t.chosen_gravity].errors.rms);
  if (!t.meets_physics_error)
    CHECK(t.kicks[t.chosen_kicks].interval == 1e-3);
}

TEST_CASE("the tuned scene is the resolved scene with the choices") {
  Tuning t;
  t.orbits = 4.0;
  bench::GravityBenchRow row;
  GravitySettings fft;
  fft.solver = GravitySettings::Solver::fft;
  fft.force_error = 5e-3;
  row.choice = {"fft", "force_error 0.005", fft};
  row.errors.rms = 2e-3;
  t.gravity = {row};
  t.kicks = {{5e-3, 0.006}};
  t.steps = {{1.25e-3, 4, 0.3, 2.0}};
  const Scene scene = parse_scene(text, "s.toml");
  const std::string written = tuned_scene(scene, chosen_keys(t, {}, scene));
  CHECK(written.find("# tune: gravity.solver = \"fft\": an rms force error of 0.2 %") != std::string::npos);
  const Scene read = parse_scene(written, "t.toml");
  CHECK(read.gravity->solver == GravitySettings::Solver::fft);
  CHECK(read.gravity->force_error == 5e-3);
  CHECK(read.gravity->kick_every == 4);
  CHECK(read.time.step == 1.25e-3);
  CHECK(read.particles.count == scene.particles.count);
  CHECK(tuned_scene(read, chosen_keys(t, {}, read)) == written);
  Tuning none;
  none.steps = {{5e-3, 1, 0.3, 2.0}};
  const Scene smooth = parse_scene(text, "s.toml", {"time.step=1e-3"});
  Scene without = smooth;
  without.gravity.reset();
  for (const ChosenKey& key : chosen_keys(none, {}, without))
    CHECK(key.path.find("gravity") == std::string::npos);
}

} // namespace tune_test
