// quality = "…" becomes fixed numbers, by the table of docs/manual/scene.md.
#include <keeler/core/error.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/quality.hpp>
#include <keeler/scene/scene.hpp>

#include <doctest/doctest.h>

namespace quality_test {

using namespace keeler;
using namespace keeler::scene;

namespace {

// Returns a patch of the A ring without the keys that a quality sets.
Scene a_ring(const std::vector<std::string>& overrides) {
  return parse_scene(R"(
planet.preset = "saturn-a-ring"
box.size_in_wavelengths = [4, 4]
particles = { optical_depth = 0.5, density = 450, sizes = { law = "equal", radius = 1 } }
gravity = {}
time.end = 1
)",
                     "s.toml", overrides);
}

Scene without_gravity(const std::vector<std::string>& overrides) {
  return parse_scene(R"(
planet.preset = "saturn-a-ring"
box.size = [100, 100]
particles = { optical_depth = 0.5, density = 450, sizes = { law = "equal", radius = 1 } }
time.end = 1
)",
                     "s.toml", overrides);
}

} // namespace

TEST_CASE("each quality sets the values of its table") {
  for (const Quality& quality : qualities) {
    CAPTURE(quality.name);
    const Scene scene = a_ring({std::string("quality=") + quality.name});
    CHECK(scene.gravity->solver == GravitySettings::Solver::automatic);
    CHECK(scene.gravity->force_error == quality.force_error);
    CHECK(scene.time.step * scene.gravity->kick_every == doctest::Approx(quality.kick_interval).epsilon(1e-12));
    CHECK(scene.time.step == doctest::Approx(0.00125).epsilon(0.25)); // of wakes at τ 0.5
    CHECK(scene.notices.empty());                                     // the times of output are whole kick intervals
  }
}

TEST_CASE("a scene that names no quality is balanced") {
  CHECK(a_ring({}).resolved == a_ring({"quality=balanced"}).resolved);
  CHECK(without_gravity({}).resolved == without_gravity({"quality=balanced"}).resolved);
  CHECK(a_ring({}).gravity->solver == GravitySettings::Solver::automatic);
}

TEST_CASE("custom leaves the keys at their defaults") {
  const Scene custom = a_ring({"quality=custom"});
  CHECK(custom.time.step == 1e-3);
  CHECK(custom.gravity->kick_every == 1);
  CHECK(custom.gravity->solver == GravitySettings::Solver::tree);
  CHECK(custom.gravity->opening_angle == 0.6);
  CHECK(a_ring({"quality=custom", "gravity.solver=fft"}).gravity->force_error == 2e-3);
}

TEST_CASE("a scene that gives all keys of a quality does not depend on the quality") {
  const std::vector<std::string> named = {"time.step=1e-3", "gravity={solver=\"tree\",opening_angle=0.6,kick_every=1}"};
  const Scene before = a_ring({"quality=custom", named[0], named[1]});
  for (const char* const quality : {"fast", "balanced", "strict"})
    CHECK(a_ring({std::string("quality=") + quality, named[0], named[1]}).motion == before.motion);
  CHECK(a_ring(named).motion == before.motion);
}

TEST_CASE("keys that a scene gives override its quality") {
  const Scene step = a_ring({"quality=balanced", "time.step=5e-4"});
  CHECK(step.time.step == 5e-4);
  CHECK(step.gravity->kick_every == 10);
  const Scene kicks = a_ring({"quality=balanced", "gravity.kick_every=2"});
  CHECK(kicks.time.step == 2.5e-3);
  CHECK(kicks.gravity->kick_every == 2);
  const Scene both = a_ring({"quality=balanced", "time.step=1e-3", "gravity.kick_every=3"});
  CHECK(both.time.step == 1e-3);
  CHECK(both.gravity->kick_every == 3);
  const Scene automatic = a_ring({"quality=strict", "time.step=auto"});
  CHECK(automatic.time.automatic);
  CHECK(automatic.gravity->force_error == 1e-3);
  const Scene tree = a_ring({"quality=strict", "gravity.solver=tree"});
  CHECK(tree.gravity->opening_angle == 0.4);
  CHECK(a_ring({"quality=strict", "gravity.image_rings=2"}).gravity->solver == GravitySettings::Solver::tree);
  CHECK(a_ring({"quality=strict", "gravity.solver=tree", "gravity.opening_angle=0.3"}).gravity->opening_angle == 0.3);
  CHECK(a_ring({"quality=strict", "gravity.solver=fft", "gravity.force_error=5e-3"}).gravity->force_error == 5e-3);
}

TEST_CASE("a larger Hill parameter shortens the kick interval") {
  const Scene dense = a_ring({"quality=balanced", "particles.density=900"}); // r_h 1.17
  CHECK(dense.time.step * dense.gravity->kick_every == doctest::Approx(2e-3));
  const Scene light = a_ring({"quality=balanced", "particles.density=200"});
  CHECK(light.time.step * light.gravity->kick_every == doctest::Approx(5e-3));
}

TEST_CASE("without self-gravity all qualities give one cheap step") {
  const Scene fast = without_gravity({"quality=fast"}), strict = without_gravity({"quality=strict"});
  CHECK(fast.time.step == strict.time.step);
  CHECK(fast.time.step == 5e-3);
  const Scene forced = without_gravity({"quality=strict", "constant_acceleration.vertical=1e-9"});
  CHECK(forced.time.step == doctest::Approx(2e-3));
}

TEST_CASE("the resolved scene holds the values and reads back to an equal scene") {
  for (const char* const quality : {"fast", "balanced", "strict"}) {
    const Scene scene = a_ring({std::string("quality=") + quality});
    const Scene again = parse_scene(scene.resolved, "r.toml"), stored = parse_stored_scene(scene.resolved, "r.toml");
    CHECK(again.resolved == scene.resolved);
    CHECK(stored.motion == scene.motion);
    CHECK(again.motion == scene.motion);
  }
}

TEST_CASE("an unknown quality is refused at its location") {
  CHECK_THROWS_WITH_AS(a_ring({"quality=best"}), doctest::Contains("quality"), UsageError);
  CHECK_THROWS_AS(a_ring({"quality=3"}), UsageError);
  CHECK_THROWS_AS(a_ring({"quality=fast", "gravity.solver=3"}), UsageError);
}

} // namespace quality_test
