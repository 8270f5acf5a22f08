#include "report.hpp"

#include "verdict.hpp"

#include <keeler/batch/run_folders.hpp>
#include <keeler/plot/figure.hpp>

#include <fmt/format.h>

#include <cmath>

namespace keeler::study {
namespace {

// Adds a setting: its cost, its error or difference y, and half the width of y's interval.
void add(const SettingMeans& setting, double y, double bound, std::vector<plot::PlotPoint>& points) {
  const double cost = setting.scatter[number_at("cpu_s_per_orbit")].mean;
  if (!std::isnan(cost) && !std::isnan(y))
    points.push_back({cost, y, std::isnan(bound) ? 0.0 : bound, setting.name});
}

std::vector<plot::PlotPoint> force_errors(const StudyMeans& means) {
  std::vector<plot::PlotPoint> points;
  for (const SettingMeans& setting : means.settings) {
    const statistics::Scatter& error = setting.scatter[number_at("force_error")];
    add(setting, error.mean, mean_bound(error), points);
  }
  return points;
}

// Returns the number that the figure shows. Boxes and sizes change the state, and the energy balance of any state
// holds.
std::size_t drawn_number(const StudyPlan& plan) {
  return number_at(plan.kind == SceneStudyKind::mesh ? "force_error"
                   : has_common_start(plan.kind)     ? "energy_balance"
                                                     : "translational_viscosity_m2_s");
}

std::vector<plot::PlotPoint> differences(const StudyMeans& means, std::size_t number) {
  const statistics::Scatter& reference = means.settings[means.reference].scatter[number];
  const double percent = 100.0 / std::fabs(reference.mean);
  std::vector<plot::PlotPoint> points;
  for (std::size_t s = 0; s < means.settings.size(); ++s) {
    const statistics::MeanDifference& difference = means.settings[s].from_reference[number];
    if (s == means.reference)
      add(means.settings[s], 0.0, percent * mean_bound(reference), points);
    else
      add(means.settings[s], percent * difference.difference, percent * difference.bound, points);
  }
  return points;
}

// Returns the range of the cost axis, wider than the points by the space for their labels.
plot::AxisRange range_of_costs(const std::vector<plot::PlotPoint>& points) {
  plot::AxisRange range;
  for (const plot::PlotPoint& point : points)
    range.include(point.x);
  return {range.low / 1.3, range.high * 1.6};
}

} // namespace

bool draw_study_figure(const StudyPlan& plan, const StudyMeans& means, const std::filesystem::path& folder) {
  const bool of_forces = plan.kind == SceneStudyKind::mesh;
  const std::vector<plot::PlotPoint> points = of_forces ? force_errors(means) : differences(means, drawn_number(plan));
  if (points.empty())
    return false;
  plot::Panel panel;
  panel.x = {.label = "processor time per orbit (s)", .log = true, .range = range_of_costs(points)};
  panel.y = {.label = of_forces ? "rms force error"
                                : fmt::format("{} (% from the reference)", study_numbers()[drawn_number(plan)].title),
             .log = of_forces};
  const auto reference_line = [&](double y, const std::string& name) {
    panel.curves.push_back(
        {name, {{panel.x.range.low, y}, {panel.x.range.high, y}}, std::nullopt, true, !name.empty()});
  };
  if (!of_forces && has_common_start(plan.kind)) {
    reference_line(100.0 * balance_tolerance, fmt::format("within {:g} %", 100.0 * balance_tolerance));
    reference_line(-100.0 * balance_tolerance, "");
    panel.curves.back().dashed = true;
  } else if (!of_forces)
    reference_line(0.0, "");
  panel.curves.push_back({.points = points, .line = false, .marks = true});
  batch::make_folder(folder / "figures");
  plot::save_figures({.panels = {panel}}, folder / "figures", "pareto");
  return true;
}

} // namespace keeler::study
