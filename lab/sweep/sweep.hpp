// Parameter sweeps: runs of one scene on a grid of keys times seeds, several at once, each in a separate folder, with
// tables and a figure of the measured quantities. Repeating the call continues a sweep that was stopped or killed;
// programs on any number of machines may work in one folder.
//
// docs/manual/commands.md describes the grid file, docs/formats.md the folder.
#pragma once

#include <keeler/batch/rows.hpp>
#include <keeler/batch/workers.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace keeler::sweep {

struct SweepSettings : batch::BatchSettings {
  std::filesystem::path grid;
  std::optional<quantities::UnitSystem> units; ///< of velocities and viscosities in the tables
  bool tables_only = false;                    ///< start no run, only write the tables of finished runs
};

/// The state of the folder after a call.
struct SweepResult : batch::BatchResult {
  bool began = false;                        ///< starting runs was requested
  std::shared_ptr<const batch::Json> points; ///< the rows of points.csv, a list; null if the sweep was stopped
  std::string figure_fault;                  ///< reason why drawing the figure failed; empty if it did not
};

/// Executes the runs that are neither finished nor held by another program, and writes the tables. All input is checked
/// before anything is written. Throws UsageError when the grid or one of its scenes is invalid, or when the folder
/// holds other files or runs with other settings; IoError.
SweepResult sweep(const SweepSettings& settings, const runs::RunRequests& requests);

} // namespace keeler::sweep
