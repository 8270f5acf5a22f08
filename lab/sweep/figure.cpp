#include "output.hpp"

#include <keeler/files/files.hpp>
#include <keeler/report/gnuplot.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace keeler {
namespace {

// The index of the axis of x, and the index of x among the keys of all axes.
struct IndexOfX {
  std::size_t axis = 0, key = 0;
};

IndexOfX index_of_x(const Grid& grid) {
  std::size_t first = 0;
  for (std::size_t axis = 0; axis < grid.axes.size(); ++axis) {
    const std::vector<std::string>& keys = grid.axes[axis].keys;
    const auto found = std::find(keys.begin(), keys.end(), grid.plot.x);
    if (found != keys.end())
      return {axis, first + static_cast<std::size_t>(found - keys.begin())};
    first += keys.size();
  }
  return {};
}

// Returns the settings on the other axes: "density = 900, time.step = 0.001".
std::string title_of(const Grid& grid, const Plan& plan, const GridPoint& point, std::size_t axis_of_x) {
  std::string title;
  std::size_t key = 0;
  for (std::size_t axis = 0; axis < grid.axes.size(); ++axis)
    for (std::size_t k = 0; k < grid.axes[axis].keys.size(); ++k, ++key)
      if (axis != axis_of_x)
        title += fmt::format("{}{} = {}", title.empty() ? "" : ", ", plan.keys[key], point.settings[key]->label);
  return title;
}

bool x_is_number(const Grid& grid, const Plan& plan) {
  const IndexOfX x = index_of_x(grid);
  return std::all_of(plan.points.begin(), plan.points.end(),
                     [&](const GridPoint& point) { return point.settings[x.key]->number.has_value(); });
}

// Returns a tic label, with % escaped: gnuplot would take it as the beginning of a format.
std::string label_string(const std::string& text) {
  std::string plain;
  for (const char c : text)
    plain += c == '%' ? "%%" : std::string(1, c);
  return gnuplot_string(plain);
}

// Returns settings that label x with words instead of numbers.
std::string words_along_x(const Grid& grid) {
  const IndexOfX x = index_of_x(grid);
  const GridAxis& axis = grid.axes[x.axis];
  const auto key =
      static_cast<std::size_t>(std::find(axis.keys.begin(), axis.keys.end(), grid.plot.x) - axis.keys.begin());
  std::string tics;
  for (std::size_t k = 0; k < axis.points.size(); ++k)
    tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ", label_string(axis.points[k][key].label), k);
  return fmt::format("set xtics ({}) noenhanced\nset xrange [-0.5:{}]\n", tics,
                     static_cast<double>(axis.points.size()) - 0.5);
}

std::string script_of(const Grid& grid, const Plan& plan, const std::vector<PlotLine>& lines) {
  const char* const colours[] = {"#1f77b4", "#c0392b", "#2e8b57", "#e67e22", "#444444", "#8e44ad"};
  const bool numbers = x_is_number(grid, plan);
  std::string script = fmt::format("set xlabel {} noenhanced\nset ylabel {} noenhanced\nset grid\nset key left top\n"
                                   "set format y '%g'\n",
                                   gnuplot_string(grid.plot.x), gnuplot_string(grid.plot.y));
  if (grid.plot.x_log && numbers)
    script += "set logscale x\n";
  if (grid.plot.y_log)
    script += "set logscale y\n";
  script += numbers ? "set offsets graph 0.03, graph 0.03, 0, 0\n" : words_along_x(grid);
  script += "plot ";
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const char* const colour = colours[k % std::size(colours)];
    const std::string title =
        lines[k].title.empty() ? "notitle" : fmt::format("title {} noenhanced", gnuplot_string(lines[k].title));
    script += fmt::format("{0}'figure.dat' index {1} using 1:2 with lines lw 1 dt 2 lc rgb '{2}' notitle, '' index "
                          "{1} using 1:2:3 with yerrorbars lw 2 pt 7 ps 0.7 lc rgb '{2}' {3}",
                          k ? ", " : "", k, colour, title);
  }
  return script + "\n";
}

} // namespace

std::vector<PlotLine> plot_lines(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points) {
  std::vector<PlotLine> lines;
  if (grid.plot.x.empty())
    return lines;
  const IndexOfX x = index_of_x(grid);
  const std::size_t y = grid.quantities.find(grid.plot.y).value();
  const bool numbers = x_is_number(grid, plan);
  std::map<std::string, std::size_t> line_of; // by title
  for (const PointRow& row : points) {
    if (!row.values[y])
      continue;
    const GridPoint& point = plan.points[row.point];
    assert(x.key < point.settings.size() && x.axis < point.on_axis.size());
    const std::string title = title_of(grid, plan, point, x.axis);
    const auto [entry, is_new] = line_of.try_emplace(title, lines.size());
    if (is_new)
      lines.push_back({title, {}});
    const Estimate& value = *row.values[y];
    lines[entry->second].points.push_back(
        {numbers ? *point.settings[x.key]->number : static_cast<double>(point.on_axis[x.axis]), value.value,
         std::isfinite(value.error) ? value.error : 0.0});
  }
  for (PlotLine& line : lines)
    std::sort(line.points.begin(), line.points.end(),
              [](const PlotLine::Point& a, const PlotLine::Point& b) { return a.x < b.x; });
  return lines;
}

Figure draw_figure(const Grid& grid, const Plan& plan, const std::vector<PointRow>& points, const RunFolders& folders) {
  const std::vector<PlotLine> lines = plot_lines(grid, plan, points);
  if (lines.empty())
    return Figure::nothing_to_draw;
  std::string data = fmt::format("# {}, {}, its standard error\n", grid.plot.x, grid.plot.y);
  for (const PlotLine& line : lines) {
    for (const PlotLine::Point& point : line.points)
      data += fmt::format("{} {} {}\n", point.x, point.y, point.error);
    data += "\n\n";
  }
  write_text(folders.path() / "figure.dat", data);
  return plot(folders.path(), "figure", script_of(grid, plan, lines), 720, 480) ? Figure::drawn : Figure::no_gnuplot;
}

} // namespace keeler
