#include "report.hpp"

#include "verdict.hpp"

#include <keeler/files/files.hpp>
#include <keeler/report/gnuplot.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {
namespace {

// Returns a point of the figure: a setting's cost, its error or difference y, and half the width of y's interval.
std::string line_of(const SettingMeans& setting, double y, double bound) {
  const double cost = setting.scatter[number_at("cpu_s_per_orbit")].mean;
  if (std::isnan(cost) || std::isnan(y))
    return {};
  return fmt::format("{} {} {} \"{}\"\n", cost, y, std::isnan(bound) ? 0.0 : bound, setting.name);
}

std::string force_errors(const StudyMeans& means) {
  std::string data;
  for (const SettingMeans& setting : means.settings) {
    const Scatter& error = setting.scatter[number_at("force_error")];
    data += line_of(setting, error.mean, mean_bound(error));
  }
  return data;
}

// Returns the number that the figure shows. Boxes and sizes change the state, and the energy balance of any state
// holds.
std::size_t drawn_number(const StudyPlan& plan) {
  return number_at(plan.kind == SceneStudyKind::mesh ? "force_error"
                   : has_common_start(plan.kind)     ? "energy_balance"
                                                     : "translational_viscosity_m2_s");
}

std::string differences(const StudyMeans& means, std::size_t number) {
  const Scatter& reference = means.settings[means.reference].scatter[number];
  const double percent = 100.0 / std::fabs(reference.mean);
  std::string data;
  for (std::size_t s = 0; s < means.settings.size(); ++s) {
    const MeanDifference& difference = means.settings[s].from_reference[number];
    data += s == means.reference
                ? line_of(means.settings[s], 0.0, percent * mean_bound(reference))
                : line_of(means.settings[s], percent * difference.difference, percent * difference.bound);
  }
  return data;
}

// Returns the range of the cost axis, wider than the points by the space for their labels.
std::string range_of_costs(const StudyMeans& means) {
  constexpr double left = 1.2, right = 1.6;
  double min_cost = HUGE_VAL, max_cost = 0.0;
  for (const SettingMeans& setting : means.settings)
    if (const double cost = setting.scatter[number_at("cpu_s_per_orbit")].mean; !std::isnan(cost)) {
      min_cost = std::min(min_cost, cost);
      max_cost = std::max(max_cost, cost);
    }
  assert(min_cost <= max_cost && "at least one setting has a cost");
  return fmt::format("set xrange [{}:{}]\n", min_cost / left, max_cost * right);
}

constexpr const char* points = "'pareto.dat' using 1:2:3 with yerrorbars lw 2 pt 7 lc rgb '#1f77b4' notitle, '' using "
                               "1:2:4 with labels left offset 0.7,0.5 rotate by 30 noenhanced notitle\n";

std::string tolerance_lines() {
  return fmt::format(
      "{0} with lines lc rgb '#999999' dt 2 title 'within {0:g} %', -{0} with lines lc rgb '#999999' dt 2 "
      "notitle, ",
      100.0 * balance_tolerance);
}

} // namespace

bool draw_study_figure(const StudyPlan& plan, const StudyMeans& means, const std::filesystem::path& folder) {
  const bool of_forces = plan.kind == SceneStudyKind::mesh;
  const StudyNumber& shown = study_numbers()[drawn_number(plan)];
  const std::string data = of_forces ? force_errors(means) : differences(means, drawn_number(plan));
  const std::filesystem::path figures = folder / "figures";
  std::filesystem::create_directories(figures);
  write_text(figures / "pareto.dat", fmt::format("# processor s per orbit, {}{}, 95 % interval, setting\n{}",
                                                 shown.title, of_forces ? "" : ": % from reference", data));
  if (data.empty())
    return false;
  std::string script = fmt::format("set logscale x 2\n{}set xlabel 'processor time per orbit (s)'\nset grid\n"
                                   "set offsets 0, 0, graph 0.15, graph 0.05\n",
                                   range_of_costs(means));
  if (of_forces)
    script += fmt::format("set logscale y\nset format y '10^{{%L}}'\nset ylabel 'rms force error'\nplot {}", points);
  else
    script += fmt::format("set ylabel '{} (% from the reference)'\nplot {}{}", shown.title,
                          has_common_start(plan.kind) ? tolerance_lines() : "0 with lines lc rgb '#999999' notitle, ",
                          points);
  return plot(figures, "pareto", script, 720, 480);
}

} // namespace keeler
