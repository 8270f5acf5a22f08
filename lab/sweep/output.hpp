// The readable output of a sweep: report.md.
#pragma once

#include "grid.hpp"
#include "tables.hpp"

#include <vector>

namespace keeler {

/// Writes report.md.
void write_report(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs,
                  const std::vector<PointRow>& points, const RunFolders& folders, bool with_figure);

} // namespace keeler
