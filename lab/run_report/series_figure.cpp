#include <keeler/run_report/series_figure.hpp>

#include "series_plots.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/runs/run_view.hpp>
#include <keeler/runs/stored_patches.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace keeler::run_report {
namespace {

// Returns "translational  0.0017 ± 0.0001", or the name alone if there is no mean.
std::string name_with_mean(const SeriesCurve& curve) {
  if (!curve.mean || !std::isfinite(curve.mean->value))
    return curve.name;
  return fmt::format("{}  {}{}", curve.name, format_number(curve.mean->value, 3),
                     std::isfinite(curve.mean->error) ? " ± " + format_number(curve.mean->error, 2) : "");
}

plot::Panel panel_of(const SeriesPlot& plot) {
  plot::Panel panel{.title = plot.unit.empty() ? plot.title : fmt::format("{} ({})", plot.title, plot.unit),
                    .x = {.label = "time (orbits)"}};
  for (const SeriesCurve& curve : plot.curves) {
    plot::PlotCurve drawn{.name = name_with_mean(curve), .colour = panel.curves.size(), .band = true};
    for (const SeriesPoint& point : curve.points)
      drawn.points.push_back({point.orbits, point.value, point.error.value_or(0.0)});
    panel.curves.push_back(drawn);
  }
  return panel;
}

plot::Figure series_figure(const SeriesPlots& plots, const std::string& title, bool light) {
  assert(!plots.plots.empty());
  plot::Figure figure{.title = title, .columns = 2, .width = 1200, .panel_height = 200};
  figure.look.theme = light ? plot::light_theme : plot::dark_theme;
  for (const SeriesPlot& plot : plots.plots)
    figure.panels.push_back(panel_of(plot));
  plot::AxisRange times;
  for (const plot::Panel& panel : figure.panels)
    for (const plot::PlotCurve& curve : panel.curves)
      for (const plot::PlotPoint& point : curve.points)
        times.include(point.x);
  for (plot::Panel& panel : figure.panels)
    panel.x.range = times.low < times.high ? times : plot::AxisRange();
  if (const auto& steady = plots.steady) {
    figure.note = fmt::format("means of orbits {} to {} (shaded){}", format_number(steady->since_orbit, 3),
                              format_number(steady->until_orbit, 4), steady->steady ? "" : ", not steady yet");
    for (plot::Panel& panel : figure.panels)
      panel.shaded = {steady->since_orbit, steady->until_orbit};
  }
  return figure;
}

} // namespace

plot::Figure run_series_figure(const std::filesystem::path& folder, bool light) {
  const runs::RunView run = runs::view_run(folder);
  const runs::StoredPatches newest = runs::load_newest_patch(folder);
  if (run.series.rows() < 2)
    throw UsageError(fmt::format("no plots of '{}': its series has fewer than two rows; let it run longer, or give "
                                 "output.series_every a smaller value",
                                 folder.string()));
  const runs::RingScale scale = runs::RingScale::of(newest.patches.back(), newest.driven, newest.gravity.has_value());
  const runs::TransportReport report = runs::TransportReport::of_run(folder, scale, {});
  return series_figure(series_plots(run.series, scale, steady_part(report)),
                       newest.title.empty() ? "Ring patch" : newest.title, light);
}

} // namespace keeler::run_report
