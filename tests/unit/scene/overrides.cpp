#include "scenes.hpp"

#include <keeler/scene/load.hpp>

#include <doctest/doctest.h>

#include <filesystem>

namespace overrides_test {

using namespace keeler;
using namespace keeler::test;

TEST_CASE("overrides take TOML values and bare words") {
  const Scene scene = parse_scene(least, "s.toml",
                                  {"particles.count=42", "box.size=[60, 70]", "gravity.solver=direct", "title=a word",
                                   "particles.sizes.radius=0.5", "planet.vertical_ratio=3.6"});
  CHECK(scene.particles.count == 42);
  CHECK(scene.size_y == 70.0);
  REQUIRE(scene.gravity);
  CHECK(scene.gravity->solver == GravitySettings::Solver::direct);
  CHECK(scene.title == "a word");
  CHECK(scene.particles.sizes.smallest == 0.5);
  CHECK(scene.planet.frequencies.nu == 3.6);
  CHECK(scene.notices.empty());
  CHECK(parse_scene(least, "s.toml", {"particles.count=42", "particles.count=43"}).particles.count == 43);
}

TEST_CASE("the number of overrides is bounded") {
  std::vector<std::string> overrides(1000, "particles.count=42");
  CHECK(parse_scene(least, "s.toml", overrides).particles.count == 42);
  overrides.emplace_back("particles.count=43");
  CHECK_THROWS_WITH_AS(parse_scene(least, "s.toml", overrides),
                       doctest::Contains("1001 overrides are too many (at most 1000"), UsageError);
}

TEST_CASE("an override replaces what the file says against it, with a notice") {
  const Scene depth = parse_scene(least, "s.toml", {"particles.optical_depth=0.2"});
  CHECK(depth.particles.count == 318); // 0.2 × 5000 / π = 318.3
  CHECK(depth.notices == std::vector<std::string>{"particles.count of the scene is ignored: --set "
                                                  "particles.optical_depth=0.2 replaces it"});

  const std::string frequencies = changed(least, "2e-4", "2e-4\nvertical_ratio = 3.6");
  const Scene preset = parse_scene(frequencies, "s.toml", {"planet.preset=saturn-f-ring"});
  CHECK(preset.planet.frequencies.nu == 1.00462);
  CHECK(preset.notices.size() == 2);

  const Scene power = parse_scene(
      least, "s.toml",
      {"particles.sizes.law=power", "particles.sizes.min=0.5", "particles.sizes.max=2", "particles.sizes.exponent=3"});
  CHECK(power.particles.sizes.largest == 2.0);
  CHECK(power.notices.size() == 1);
  const Scene whole = parse_scene(least, "s.toml", {"particles.sizes={law='equal', radius=2}"});
  CHECK(whole.particles.sizes.smallest == 2.0);

  const Scene start = parse_scene(least, "s.toml", {"start.from=wakes.hdf"});
  CHECK(*start.start_from == (std::filesystem::current_path() / "wakes.hdf").string());
  CHECK(start.size_x == 0.0);
  CHECK(start.notices.size() == 2);
}

TEST_CASE("messages on --from name it") {
  const Scene start = parse_scene(least, "s.toml", {}, "wakes.hdf");
  CHECK(*start.start_from == (std::filesystem::current_path() / "wakes.hdf").string());
  CHECK(start.notices == std::vector<std::string>{"box of the scene is ignored: --from wakes.hdf replaces it",
                                                  "particles of the scene is ignored: --from wakes.hdf replaces it"});
  try {
    parse_scene(least, "s.toml", {}, "");
    CHECK(false);
  } catch (const UsageError& error) {
    CHECK(std::string(error.what()).rfind("--from : start.from is \"\", but must be the path of a file", 0) == 0);
  }
}

TEST_CASE("a faulty override is reported by its text") {
  CHECK(fault(least, {"particles.cuont=5"}) ==
        "--set particles.cuont=5: unknown key particles.cuont (no scene has it); did you mean \"count\"?");
  CHECK(fault(least, {"particles.count=many"}) ==
        "--set particles.count=many: particles.count is a string, but must be a whole number from 1 to 1e9 (number of "
        "particles); write for example count = 10000");
  CHECK(fault(least, {"wibble.wobble=1"}).rfind("--set wibble.wobble=1: unknown table wibble", 0) == 0);
  CHECK(
      fault(least, {"particles.sizes.radius=-1"}).rfind("--set particles.sizes.radius=-1: particles.sizes.radius", 0) ==
      0);
  for (const std::string bad : {"particles.count", "=5", ".count=5", "particles..count=5", "a b=5", ""})
    CHECK(fault(least, {bad}) ==
          "--set " + bad + ": not an override (it needs a key and a value); write --set table.key=value");
  CHECK(fault(least, {"particles.count=5", "particles.optical_depth=0.5"}).find("cannot be combined with") !=
        std::string::npos);
  CHECK(fault(least, {"title=a\nb=2"}) == "");
  CHECK(fault(least, {"particles=3"}).find("particles is a whole number, but must be a table") != std::string::npos);
}

} // namespace overrides_test
