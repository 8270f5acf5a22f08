// The readable output of a sweep: figure.svg (with its data, gnuplot script and PNG) and report.md.
#pragma once

#include "grid.hpp"
#include "tables.hpp"

#include <string>
#include <vector>

namespace keeler {

/// A line of the plot, for one combination of values on the axes other than the axis of x.
struct PlotLine {
  std::string title; ///< empty if there is only one line
  struct Point {
    double x = 0.0, y = 0.0, error = 0.0; ///< 0 if the error is not known
  };
  std::vector<Point> points;
};

/// Returns the lines through the points that have y. If x is not a number, its index on the axis is used.
std::vector<PlotLine> plot_lines(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points);

enum class Figure { drawn, nothing_to_draw, no_gnuplot, failed };

/// Writes the data, the script and the figure. Throws IoError when gnuplot fails.
Figure draw_figure(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points, const RunFolders& folders);

/// Writes report.md.
void write_report(const Grid& grid, const Plan& plan, const std::vector<RunRow>& runs,
                  const std::vector<PointRow>& points, const RunFolders& folders, Figure figure);

} // namespace keeler
