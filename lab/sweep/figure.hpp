// The figure of a sweep: the quantity that the grid asks for along an axis, with errors.
#pragma once

#include "grid.hpp"
#include "tables.hpp"

#include <keeler/plot/figure.hpp>

#include <vector>

namespace keeler::sweep {

/// Returns the curves through the points that have y, one for each combination of values on the other axes. If x is not
/// a number, its index on the axis is used.
std::vector<plot::PlotCurve> sweep_curves(const Grid& grid, const Plan& plan,
                                          const std::vector<batch::PointRow>& points);

/// Writes figure.svg and figure.png. Returns false if there is nothing to draw. Throws IoError.
bool draw_figure(const Grid& grid, const Plan& plan, const std::vector<batch::PointRow>& points,
                 const batch::RunFolders& folders);

} // namespace keeler::sweep
