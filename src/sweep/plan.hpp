// The runs of a grid: every point with every seed, each with its name and its checked scene.
#pragma once

#include "grid.hpp"

#include <keeler/batch/planned_run.hpp>
#include <keeler/core/progress.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler {

/// A point of the grid: where it stands on each axis.
struct GridPoint {
  std::vector<std::size_t> on_axis;       ///< index of the value, an axis each
  std::vector<const GridValue*> settings; ///< of all keys of all axes, in their order; they belong to the grid
};

/// The last axis changes fastest. Runs of a point stand together, in the order of the seeds. A run's name depends on
/// its point's keys and values and on the seed, on nothing else.
struct Plan {
  std::vector<GridPoint> points;
  std::vector<PlannedRun> runs;
  std::vector<std::string> keys; ///< of all axes
};

/// Checks the scene of every run, and tells how far it is where they are many. The grid must outlive the plan. Throws
/// UsageError for the first fault and for a grid of too many runs, Interrupted (interrupt.hpp).
Plan plan_runs(const Grid& grid, const std::function<void(const Progress&)>& progress = {});

} // namespace keeler
