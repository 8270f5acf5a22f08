// The file of a sweep: which scene, which keys take which values, which seeds, and what is plotted.
//
//     scene = "equilibrium.toml"   # relative to this file
//     seeds = [1, 2, 3]
//     since = 10.0                 # orbits; without it the beginning of the steady part is found
//     [set]                        # the same for all runs
//     "time.end" = 30.0
//     [[axis]]                     # axes are crossed
//     key = "particles.optical_depth"
//     values = [0.25, 0.5]
//     [[axis]]                     # keys of one axis change together
//     keys = ["box.size", "particles.density"]
//     values = [[[50, 50], 900], [[80, 80], 450]]
//     [plot]
//     y = "total_viscosity_m2_s"
#pragma once

#include <keeler/batch/quantities.hpp>
#include <keeler/config/overrides.hpp>
#include <keeler/scene/scene.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// A value that a key of the scene takes.
struct GridValue {
  Override override; ///< the key, the value as TOML, and where both stand
  std::string label; ///< the value in names and tables: a number or a word as it is, anything else as TOML
  std::optional<double> number;
};

/// Keys that change together, and the values that they take: one list of values a point, in the order of the keys.
struct GridAxis {
  std::vector<std::string> keys;
  std::vector<std::vector<GridValue>> points;
};

struct GridPlot {
  std::string x; ///< a key of an axis; empty: there is no axis
  std::string y = "total_viscosity_m2_s";
  std::string y_place; ///< where y stands; empty for the default
  bool x_log = false, y_log = false;
};

struct Grid {
  std::filesystem::path file, scene;
  std::string text; ///< of the file
  std::optional<double> since;
  std::string since_place;
  std::vector<GridValue> seeds; ///< values of particles.seed; empty: the scene's own
  std::vector<GridValue> set;
  std::vector<GridAxis> axes;
  GridPlot plot;
  RunQuantities quantities; ///< of its tables
};

/// Reads a grid, with more quantities for its tables than every sweep has; what the scene says to its keys and values
/// is not asked. Throws UsageError "file:line:column: problem; what to do" for the first fault.
Grid read_grid(const std::filesystem::path& file, const std::vector<std::string>& quantities = {});

} // namespace keeler
