// The grid file of a sweep: the scene, the values of its keys, the seeds, and the quantity that is plotted.
//
//     scene = "equilibrium.toml"   # relative to this file
//     seeds = [1, 2, 3]
//     since = 10.0                 # orbits; default: the detected beginning of the steady part
//     [set]                        # for all runs
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

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler::sweep {

/// A value of a key of the scene.
struct GridValue {
  config::Override override; ///< the key, the value as TOML, and their positions in the file
  std::string label;         ///< text in names and tables: a number or a word unchanged, anything else as TOML
  std::optional<double> number;
};

/// Keys that change together, and their values: one list per point, in the order of the keys.
struct GridAxis {
  std::vector<std::string> keys;
  std::vector<std::vector<GridValue>> points;
};

struct GridPlot {
  std::string x; ///< a key of an axis; empty if there is no axis
  std::string y = "total_viscosity_m2_s";
  std::string y_position; ///< position of y in the file; empty for the default
  bool x_log = false, y_log = false;
};

struct Grid {
  std::filesystem::path file, scene;
  std::string text; ///< content of the file
  std::optional<double> since;
  std::string since_position;
  std::vector<GridValue> seeds; ///< values of particles.seed; empty: the seed of the scene
  std::vector<GridValue> set;
  std::vector<GridAxis> axes;
  GridPlot plot;
  batch::RunQuantities quantities; ///< columns of the tables
};

/// Reads a grid, with additional quantities for its tables and the units of their velocities and viscosities. Its keys
/// and values are not checked against the scene. Throws UsageError "file:line:column: problem; what to do" for the
/// first fault.
Grid read_grid(const std::filesystem::path& file, const std::vector<std::string>& quantities = {},
               std::optional<quantities::UnitSystem> units = std::nullopt);

} // namespace keeler::sweep
