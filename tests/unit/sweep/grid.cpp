#include "grids.hpp"

#include <doctest/doctest.h>

namespace grid_test {

using namespace keeler;
using namespace keeler::sweep;
using namespace keeler::test;

TEST_CASE("a grid holds what its file says") {
  const GridFile file(R"(
scene = "scene.toml"
seeds = [3, 1]
since = 2
[set]
"time.end" = 3.0
time.step = 1e-3
"particles.sizes" = { law = "power", exponent = 3.0, min = 0.5, max = 1.0 }
[[axis]]
key = "particles.optical_depth"
values = [0.25, 1.0]
[[axis]]
keys = ["box.size", "start.from"]
values = [[[50, 60.5], "here.hdf"], [[80, 80], "/there.hdf"]]
[plot]
x = "box.size"
y = "scale_height_m"
y_log = true
)");
  const Grid grid = file.grid();
  CHECK(grid.since == 2.0);
  REQUIRE(grid.seeds.size() == 2);
  CHECK(grid.seeds[0].override.key == "particles.seed");
  CHECK(grid.seeds[0].override.value == "3");
  REQUIRE(grid.set.size() == 3);
  for (const GridValue& value : grid.set)
    if (value.override.key == "time.end")
      CHECK(value.override.value == "3.0");
    else if (value.override.key == "time.step")
      CHECK(value.override.value == "0.001");
    else
      CHECK(value.override.value == "{ exponent = 3.0, law = \"power\", max = 1.0, min = 0.5 }");
  REQUIRE(grid.axes.size() == 2);
  CHECK(grid.axes[0].points[1].front().label == "1");
  CHECK(grid.axes[0].points[1].front().override.value == "1.0");
  CHECK(grid.axes[0].points[1].front().number == 1.0);
  CHECK(grid.axes[0].points[0].front().override.value_location == file.path().string() + ":11:11");
  CHECK(grid.axes[1].points[0][0].label == "[50, 60.5]");
  CHECK_FALSE(grid.axes[1].points[0][0].number);
  CHECK(grid.axes[1].points[0][1].override.value ==
        "\"" + (file.path().parent_path() / "here.hdf").string() + "\""); // relative to the grid
  CHECK(grid.axes[1].points[1][1].override.value == "\"/there.hdf\"");
  CHECK(grid.plot.x == "box.size");
  CHECK(grid.plot.y == "scale_height_m");
  CHECK(grid.plot.y_log);
  CHECK_FALSE(grid.plot.x_log);
}

TEST_CASE("each fault of a grid is one line with its position and what to do") {
  const std::string scene = "scene = \"scene.toml\"\n";
  const std::string axis = "[[axis]]\nkey = \"particles.optical_depth\"\n";
  struct Case {
    std::string text, position, words;
  };
  const Case cases[] = {
      {"scene = ", "grid.toml:1:", "not TOML"},
      {"seeds = [1]\n", "grid.toml:1:1: ", "scene is missing"},
      {"scene = 3\n", "grid.toml:1:9: ", "scene must be the path"},
      {"scene = \"none.toml\"\n", "grid.toml:1:9: ", "does not exist"},
      {scene + "seed = [1]\n", "grid.toml:2:1: ", "unknown key seed"},
      {scene + "seeds = []\n", "grid.toml:2:9: ", "seeds is empty"},
      {scene + "seeds = 3\n", "grid.toml:2:9: ", "a list of whole numbers"},
      {scene + "seeds = [1, 2, 1]\n", "grid.toml:2:16: ", "the seed 1 is listed twice"},
      {scene + "seeds = [1.5]\n", "grid.toml:2:10: ", "particles.seed is a number with a fraction"},
      {scene + "since = \"10\"\n", "grid.toml:2:9: ", "since must be a number"},
      {scene + "since = 1.0\n", "grid.toml:2:9: ", "not before the end"},
      {scene + "[set]\n\"time.ends\" = 3\n", "grid.toml:3:1: ", "did you mean \"end\"?"},
      {scene + "[set]\n\"time.end\" = \"long\"\n", "grid.toml:3:14: ", "time.end is a string"},
      {scene + "[set]\nparticles.seed = 3\n", "grid.toml:3:11: ", "given by seeds"},
      {scene + "[set]\n\"time.end\" = 1979-05-27\n", "grid.toml:3:14: ", "date or time"},
      {scene + "axis = 3\n", "grid.toml:2:8: ", "[[axis]]"},
      {scene + "[[axis]]\nvalues = [1]\n", "grid.toml:2:1: ", "either key or keys"},
      {scene + "[[axis]]\nkeys = []\nvalues = [1]\n", "grid.toml:3:8: ", "keys is empty"},
      {scene + axis + "values = []\n", "grid.toml:4:10: ", "the axis of particles.optical_depth has no values"},
      {scene + axis, "grid.toml:2:1: ", "the axis of particles.optical_depth has no values"},
      {scene + axis + "value = [1]\n", "grid.toml:4:1: ", "unknown key value"},
      {scene + axis + "values = [0.5, 0.50]\n", "grid.toml:4:16: ", "0.5 is listed twice"},
      {scene + axis + "values = [0.5, -1]\n", "grid.toml:4:16: ", "particles.optical_depth is -1"},
      {scene + "[[axis]]\nkey = \"particles.optcal_depth\"\nvalues = [1]\n",
       "grid.toml:3:7: ", "did you mean \"optical_depth\"?"},
      {scene + "[[axis]]\nkeys = [\"time.end\", \"time.step\"]\nvalues = [[1.0]]\n",
       "grid.toml:4:11: ", "a list of 2 values"},
      {scene + axis + "values = [1]\n" + axis + "values = [2]\n", "grid.toml:6:7: ", "given twice"},
      {scene + axis + "values = [1]\n[plot]\nx = \"time.end\"\n", "grid.toml:6:5: ", "is not a key of an axis"},
      {scene + axis + "values = [1]\n[plot]\ny = \"viscosity\"\n", "grid.toml:6:5: ", "choose one of"},
      {scene + "[[axis]]\nkey = \"particles.sizes.radius\"\nvalues = [100]\n",
       "scene.toml:", "in the run radius-100_seed"},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    const std::string fault = GridFile(c.text).fault();
    CAPTURE(fault);
    CHECK(fault.starts_with(c.position));
    CHECK(fault.find(c.words) != fault.npos);
    CHECK(fault.find('\n') == fault.npos);
  }
}

} // namespace grid_test
