// The readable output of a sweep: report.md.
#pragma once

#include "grid.hpp"
#include "tables.hpp"

#include <vector>

namespace keeler::sweep {

/// Writes report.md.
void write_report(const Grid& grid, const Plan& plan, const std::vector<batch::RunRow>& runs,
                  const std::vector<batch::PointRow>& points, const batch::RunFolders& folders, bool with_figure);

} // namespace keeler::sweep
