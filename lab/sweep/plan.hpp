// The runs of a grid: every point with every seed, each with its name and its validated scene.
#pragma once

#include "grid.hpp"

#include <keeler/batch/planned_run.hpp>
#include <keeler/core/progress.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler::sweep {

/// A point of the grid: its index on each axis.
struct GridPoint {
  std::vector<std::size_t> on_axis;       ///< index of the value, for each axis
  std::vector<const GridValue*> settings; ///< values of all keys of all axes, in their order; owned by the grid
};

/// All points and runs; the last axis changes fastest. Runs of a point are contiguous, in the order of the seeds. A
/// run's name depends only on the keys and values of its point and on the seed.
struct Plan {
  std::vector<GridPoint> points;
  std::vector<batch::PlannedRun> runs;
  std::vector<std::string> keys; ///< keys of all axes
};

/// Plans the runs and validates the scene of each; reports progress if there are many. The grid must outlive the plan.
/// Throws UsageError for the first fault and for a grid of too many runs, Interrupted (interrupt.hpp).
Plan plan_runs(const Grid& grid, const std::function<void(const Progress&)>& progress = {});

} // namespace keeler::sweep
