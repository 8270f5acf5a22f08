#include "report.hpp"

#include "verdict.hpp"

#include <keeler/files/files.hpp>
#include <keeler/report/gnuplot.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler {
namespace {

// A point of the picture: a setting's cost, its error or difference, and the interval of that.
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

// What the picture of such a study shows: boxes and sizes change the state, and its balance holds whatever they are.
std::size_t drawn_number(const StudyPlan& plan) {
  return number_at(plan.kind == SceneStudyKind::mesh ? "force_error"
                   : shares_start(plan.kind)         ? "energy_balance"
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

// Wider than the points, so that their names have room.
std::string range_of_costs(const StudyMeans& means) {
  constexpr double left = 1.2, right = 1.6;
  double least = HUGE_VAL, most = 0.0;
  for (const SettingMeans& setting : means.settings)
    if (const double cost = setting.scatter[number_at("cpu_s_per_orbit")].mean; !std::isnan(cost)) {
      least = std::min(least, cost);
      most = std::max(most, cost);
    }
  return fmt::format("set xrange [{}:{}]\n", least / left, most * right);
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
    script +=
        fmt::format("set ylabel '{} (% from the reference)'\nplot {}{}", shown.title,
                    shares_start(plan.kind) ? tolerance_lines() : "0 with lines lc rgb '#999999' notitle, ", points);
  return plot(figures, "pareto", script, 720, 480);
}

} // namespace keeler
