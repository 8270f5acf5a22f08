#include "grids.hpp"

#include "draws.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

namespace plan_test {

using namespace keeler;
using namespace keeler::sweep;
using namespace keeler::test;

namespace {

const char* const crossed = R"(
scene = "scene.toml"
seeds = [7, 2]
[[axis]]
keys = ["particles.optical_depth", "box.size"]
values = [[0.2, [40, 40]], [0.4, [30, 30]]]
[[axis]]
key = "collisions.restitution"
values = [{ law = "constant", value = 0.5 }, { law = "bridges", scale = 0.34 }]
)";

std::vector<std::string> names_of(const Plan& plan) {
  std::vector<std::string> names;
  for (const batch::PlannedRun& run : plan.runs)
    names.push_back(run.name);
  return names;
}

} // namespace

TEST_CASE("axes are crossed, keys of one axis change together, and each point has every seed") {
  const GridFile file(crossed);
  const Grid grid = file.grid();
  const Plan plan = plan_runs(grid);
  REQUIRE(plan.points.size() == 4);
  REQUIRE(plan.runs.size() == 8);
  CHECK(plan.keys == std::vector<std::string>{"particles.optical_depth", "box.size", "collisions.restitution"});
  for (std::size_t k = 0; k < 8; ++k) {
    const batch::PlannedRun& run = plan.runs[k];
    CHECK(run.point == k / 2);
    CHECK(run.seed == (k % 2 == 0 ? 7 : 2));
    CHECK(run.scene.particles.seed == run.seed);
    CHECK(run.scene.size_x == (k < 4 ? 40.0 : 30.0));
    CHECK(run.scene.optical_depth() == doctest::Approx(k < 4 ? 0.2 : 0.4).epsilon(0.02));
    const bool bridges = run.scene.resolved.find("bridges") != std::string::npos;
    CHECK(bridges == (k / 2 % 2 == 1));
  }
  const std::vector<std::string> names = names_of(plan);
  CHECK(std::set(names.begin(), names.end()).size() == 8);
  CHECK(names.front().starts_with("optical_depth-0.2_size-40x40_restitution-"));
  CHECK(names.front().ends_with("_seed-7"));
}

TEST_CASE("more points and seeds leave the names of the others as they are") {
  const GridFile before("scene = \"scene.toml\"\nseeds = [1]\n[[axis]]\nkey = \"time.step\"\nvalues = [1e-3, 5e-3]\n");
  const GridFile after(
      "scene = \"scene.toml\"\nseeds = [2, 1]\n[[axis]]\nkey = \"time.step\"\nvalues = [2e-3, 0.005, 0.001]\n");
  const Grid grid = before.grid(), larger = after.grid();
  const std::vector<std::string> old_names = names_of(plan_runs(grid)), new_names = names_of(plan_runs(larger));
  CHECK(old_names == std::vector<std::string>{"step-0.001_seed-1", "step-0.005_seed-1"});
  for (const std::string& name : old_names)
    CHECK(std::count(new_names.begin(), new_names.end(), name) == 1);
}

TEST_CASE("without axes and seeds there is one run, with the scene's seed") {
  const GridFile plain("scene = \"scene.toml\"\n");
  const Grid one = plain.grid();
  const Plan plan = plan_runs(one);
  REQUIRE(plan.runs.size() == 1);
  CHECK(plan.runs.front().name == "seed-1");
  CHECK(plan.points.size() == 1);
}

TEST_CASE("a grid of too many runs, too deep a one or one with too many keys is refused at once") {
  const auto list = [](std::size_t count) {
    std::string numbers;
    for (std::size_t k = 1; k <= count; ++k)
      numbers += std::to_string(k) + ", ";
    return "[" + numbers + "]";
  };
  const std::string scene = "scene = \"scene.toml\"\n";
  const std::string million = test::sanitized // whose reading is long there
                                  ? list(1000) + "\n[[axis]]\nkey = \"a\"\nvalues = " + list(1000)
                                  : list(1000000);
  CHECK(GridFile(scene + "seeds = " + million + "\n").fault() ==
        "grid.toml:1:1: the grid makes 1000000 runs (a sweep takes 100000 at most); give it fewer seeds or values, or "
        "make several grids");
  std::string five_axes = scene;
  for (const char* const letter : {"a", "b", "c", "d", "e"})
    five_axes += std::string("[[axis]]\nkey = \"") + letter + "\"\nvalues = " + list(10000) + "\n";
  CHECK(GridFile(five_axes).fault().rfind("grid.toml:1:1: the grid makes 1e20 runs", 0) == 0);
  std::string dots;
  for (int k = 0; k < 100000; ++k)
    dots += "a.";
  CHECK(GridFile(scene + "[set]\n" + dots + "b = 1\n").fault().find("a name of more than 16 parts") !=
        std::string::npos);
  CHECK(GridFile(scene + "[set]\n\"" + dots + "b\" = 1\n").fault().find("unknown key of 200001 bytes") !=
        std::string::npos);
  std::string many = scene + "[set]\n";
  for (int k = 0; k < 2000; ++k)
    many += "k" + std::to_string(k) + " = 1\n";
  CHECK(GridFile(many).fault().find("the grid has more than 1000 keys") != std::string::npos);
  CHECK(GridFile("\xef\xbb\xbf" + scene).fault() == "");
  CHECK(GridFile(scene + "seeds = [1e3, 2]\n").fault() == "");
  CHECK(GridFile(scene + "seeds = [18446744073709551615]\n").fault().find("the number is too large") !=
        std::string::npos);
}

} // namespace plan_test
