#include "figure.hpp"

#include <keeler/scene/keys.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

namespace keeler::sweep {
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
std::string name_of(const Grid& grid, const Plan& plan, const GridPoint& point, std::size_t axis_of_x) {
  std::string name;
  std::size_t key = 0;
  for (std::size_t axis = 0; axis < grid.axes.size(); ++axis)
    for (std::size_t k = 0; k < grid.axes[axis].keys.size(); ++k, ++key)
      if (axis != axis_of_x)
        name += fmt::format("{}{} = {}", name.empty() ? "" : ", ", plan.keys[key], point.settings[key]->label);
  return name;
}

bool x_is_number(const Grid& grid, const Plan& plan) {
  const IndexOfX x = index_of_x(grid);
  return std::all_of(plan.points.begin(), plan.points.end(),
                     [&](const GridPoint& point) { return point.settings[x.key]->number.has_value(); });
}

// Returns words that label x instead of numbers.
std::vector<std::string> words_along_x(const Grid& grid) {
  const GridAxis& axis = grid.axes[index_of_x(grid).axis];
  const auto key = std::find(axis.keys.begin(), axis.keys.end(), grid.plot.x) - axis.keys.begin();
  std::vector<std::string> words;
  for (const auto& point : axis.points)
    words.push_back(point[static_cast<std::size_t>(key)].label);
  return words;
}

// Returns the key with its unit: "particles.density (kg/m³)".
std::string label_of_key(const std::string& path) {
  const Key* const key = scene::find_key(path);
  if (key == nullptr || key->unit.empty() || key->unit == "1")
    return path;
  std::string unit = key->unit;
  for (const auto& [plain, raised] : {std::pair("^2", "²"), std::pair("^3", "³")})
    if (const std::size_t at = unit.find(plain); at != std::string::npos)
      unit.replace(at, 2, raised);
  return fmt::format("{} ({})", path, unit);
}

} // namespace

std::vector<plot::PlotCurve> sweep_curves(const Grid& grid, const Plan& plan,
                                          const std::vector<batch::PointRow>& points) {
  std::vector<plot::PlotCurve> curves;
  if (grid.plot.x.empty())
    return curves;
  const IndexOfX x = index_of_x(grid);
  const std::size_t y = grid.quantities.find(grid.plot.y).value();
  const bool numbers = x_is_number(grid, plan);
  std::map<std::string, std::size_t> curve_of; // by name
  for (const batch::PointRow& row : points) {
    if (!row.values[y])
      continue;
    const GridPoint& point = plan.points[row.point];
    assert(x.key < point.settings.size() && x.axis < point.on_axis.size());
    const std::string name = name_of(grid, plan, point, x.axis);
    const auto [entry, is_new] = curve_of.try_emplace(name, curves.size());
    if (is_new)
      curves.push_back({.name = name, .colour = curves.size(), .dashed = true, .marks = true});
    const Estimate& value = *row.values[y];
    curves[entry->second].points.push_back(
        {numbers ? *point.settings[x.key]->number : static_cast<double>(point.on_axis[x.axis]), value.value,
         std::isfinite(value.error) ? value.error : 0.0});
  }
  for (plot::PlotCurve& curve : curves)
    std::sort(curve.points.begin(), curve.points.end(),
              [](const plot::PlotPoint& a, const plot::PlotPoint& b) { return a.x < b.x; });
  return curves;
}

bool draw_figure(const Grid& grid, const Plan& plan, const std::vector<batch::PointRow>& points,
                 const batch::RunFolders& folders) {
  const std::vector<plot::PlotCurve> curves = sweep_curves(grid, plan, points);
  if (curves.empty())
    return false;
  plot::PlotAxis x{.label = label_of_key(grid.plot.x), .log = grid.plot.x_log};
  const batch::RunColumn& drawn = grid.quantities.columns()[grid.quantities.find(grid.plot.y).value()];
  const plot::PlotAxis y{.label = drawn.name, .log = grid.plot.y_log};
  if (!x_is_number(grid, plan)) {
    x.log = false;
    x.words = words_along_x(grid);
    x.range = {-0.5, static_cast<double>(x.words.size()) - 0.5};
  }
  plot::save_figures({.panels = {{.x = x, .y = y, .curves = curves}}}, folders.path(), "figure");
  return true;
}

} // namespace keeler::sweep
