#include <keeler/run_report/series_figure.hpp>

#include "series_plots.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/runs/run_view.hpp>
#include <keeler/runs/stored_patches.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::run_report {
namespace {

using Json = nlohmann::ordered_json;

// Returns "translational  0.0017 ± 0.0001", or the name alone if there is no mean.
std::string name_with_mean(const Json& curve) {
  const auto name = curve["name"].get<std::string>();
  const Json& mean = curve["mean"];
  if (!mean.is_object() || !mean["value"].is_number())
    return name;
  return fmt::format("{}  {}{}", name, format_number(mean["value"], 3),
                     mean["error"].is_number() ? " ± " + format_number(mean["error"], 2) : "");
}

plot::Panel panel_of(const Json& plot) {
  const auto title = plot["title"].get<std::string>(), unit = plot["unit"].get<std::string>();
  plot::Panel panel{.title = unit.empty() ? title : fmt::format("{} ({})", title, unit),
                    .x = {.label = "time (orbits)"}};
  for (const Json& curve : plot["curves"]) {
    plot::PlotCurve drawn{.name = name_with_mean(curve), .colour = panel.curves.size(), .band = true};
    for (const Json& point : curve["points"])
      drawn.points.push_back({point[0], point[1], point[2].is_number() ? point[2].get<double>() : 0.0});
    panel.curves.push_back(drawn);
  }
  return panel;
}

} // namespace

plot::Figure series_figure(const Json& plots, const std::string& title, bool light) {
  assert(!plots["plots"].empty());
  plot::Figure figure{.title = title, .columns = 2, .width = 1200, .panel_height = 200};
  figure.look.theme = light ? plot::light_theme : plot::dark_theme;
  for (const Json& plot : plots["plots"])
    figure.panels.push_back(panel_of(plot));
  plot::AxisRange times;
  for (const plot::Panel& panel : figure.panels)
    for (const plot::PlotCurve& curve : panel.curves)
      for (const plot::PlotPoint& point : curve.points)
        times.include(point.x);
  for (plot::Panel& panel : figure.panels)
    panel.x.range = times.low < times.high ? times : plot::AxisRange();
  if (const Json& steady = plots["steady"]; steady.is_array()) {
    figure.note =
        fmt::format("means of orbits {} to {} (shaded)", format_number(steady[0], 3), format_number(steady[1], 4));
    for (plot::Panel& panel : figure.panels)
      panel.shaded = {steady[0], steady[1]};
  }
  return figure;
}

plot::Figure run_series_figure(const std::filesystem::path& folder, bool light) {
  const runs::RunView run = runs::view_run(folder);
  const runs::StoredPatches newest = runs::load_newest_patch(folder);
  if (run.series.rows() < 2)
    throw UsageError(fmt::format("no plots of '{}': its series has fewer than two rows; let it run longer, or give "
                                 "output.series_every a smaller value",
                                 folder.string()));
  const runs::RingScale scale = runs::RingScale::of(newest.patches.back(), newest.driven);
  const runs::TransportReport report = runs::TransportReport::of_run(folder, scale, {});
  return series_figure(series_plots(run.series, scale, steady_part(report)),
                       newest.title.empty() ? "Ring patch" : newest.title, light);
}

} // namespace keeler::run_report
