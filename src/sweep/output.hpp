// What people look at after a sweep: figure.svg (with its data, gnuplot script and PNG) and report.md.
#pragma once

#include "grid.hpp"
#include "tables.hpp"

#include <string>
#include <vector>

namespace keeler {

/// Lines of the plot: one for each combination of the axes that x is not on.
struct PlotLine {
  std::string title; ///< empty: there is but one
  struct Point {
    double x = 0.0, y = 0.0, error = 0.0; ///< 0 where the error is not known
  };
  std::vector<Point> points;
};

/// Of the points that have y. Where x is no number it is the place on the axis, from 0.
std::vector<PlotLine> plot_lines(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points);

enum class Figure { drawn, nothing_to_draw, no_gnuplot, failed };

Figure draw_figure(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points, const RunFolders& folders);

/// Writes report.md.
void write_report(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs,
                  const std::vector<PointRow>& points, const RunFolders& folders, Figure figure);

} // namespace keeler
