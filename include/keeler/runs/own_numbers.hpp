// Numbers of a calling program among those that Keeler reports: columns of series.csv and quantities of `analyze`.
#pragma once

#include <keeler/core/key.hpp>
#include <keeler/particles/patch.hpp>
#include <keeler/scene/scene.hpp>
#include <keeler/simulation/simulation.hpp>

#include <filesystem>
#include <functional>
#include <string>

namespace keeler::runs {

/// A column of series.csv, after Keeler's. All texts are literals in UTF-8.
struct OwnColumn {
  const char* name;    ///< in the header, with its unit: "gas_torque_n_m"
  const char* unit;    ///< "N m"; "1" for a pure number
  const char* plot;    ///< "TITLE: CURVE" in plots; columns of one title are curves of one plot
  const char* meaning; ///< a line for people
  /// Returns the value between two steps. Collective: all ranks call it, and the value of the root is written. It must
  /// not change the simulation. A value that is not finite is written as nan or inf.
  std::function<double(const Simulation& simulation, const Scene& scene)> value;
  bool (*in)(const Scene& scene) = nullptr; ///< true for scenes that have the column; null: all scenes
};

/// A quantity that `analyze` reports of snapshots: the mean over them. All texts are literals in UTF-8.
struct OwnQuantity {
  const char* name;                                   ///< in JSON and tables, with its unit: "gas_torque_n_m"
  const char* unit;                                   ///< in texts: "N m"; empty for a pure number
  const char* label;                                  ///< in texts and on pages; empty: not shown there
  const char* meaning;                                ///< a line for people
  std::function<double(const Patch& snapshot)> value; ///< a value that is not finite is unknown
};

/// Add a number of the calling program, in any thread. They come in the order of their names. Throw UsageError for a
/// name that is taken or has more than small letters, digits and '_'. A run that has begun keeps its columns; it goes
/// on in a program without them only if series.csv is removed.
void add_series_column(const OwnColumn& column, IfTaken if_taken = IfTaken::refuse);
/// As add_series_column(), for a quantity.
void add_quantity(const OwnQuantity& quantity, IfTaken if_taken = IfTaken::refuse);

/// Returns the quantities of a snapshot, or of the steady part of a run's folder, with the added ones: the JSON that
/// `keeler analyze PATH --json` prints. Throws IoError; UsageError if there is nothing to measure.
std::string analyze_json(const std::filesystem::path& path);

} // namespace keeler::runs
