// The tables of a sweep: one row per run, and one row per point of the grid with means over the seeds.
#pragma once

#include "plan.hpp"

#include <keeler/batch/rows.hpp>

#include <vector>

namespace keeler::sweep {

/// Returns a list of objects with one member per column, null for unknown values: of the finished and failed runs, and
/// of the points with a finished run.
batch::Json runs_as_json(const Grid& grid, const Plan& plan, const std::vector<batch::RunRow>& runs);
batch::Json points_as_json(const Grid& grid, const Plan& plan, const std::vector<batch::PointRow>& points);

/// Writes report.md.
void write_report(const Grid& grid, const Plan& plan, const std::vector<batch::RunRow>& runs,
                  const std::vector<batch::PointRow>& points, const batch::RunFolders& folders, bool with_figure);

} // namespace keeler::sweep
