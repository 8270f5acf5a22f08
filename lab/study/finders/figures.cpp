#include "measurements.hpp"
#include "perturbed_ring/perturbed_ring.hpp"
#include "report.hpp"

#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/finders/finder.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/plot/figure.hpp>
#include <keeler/render/patch_picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <functional>

namespace keeler::study {
namespace {

namespace fs = std::filesystem;

// Returns the results of the drift in drawing order: all finders, then the straight paths by step.
std::vector<const Json*> drift_results(const FinderStudyData& data) {
  std::vector<const Json*> results;
  for (const auto& [name, result] : data.results)
    if (name.starts_with("drift/") && !result.at("path").get<std::string>().starts_with("straight"))
      results.push_back(&result);
  for (const char* path : {control_path, straight_path})
    for (const auto& [name, result] : data.results)
      if (name.starts_with("drift/") && result.at("path") == path)
        results.push_back(&result);
  return results;
}

// Returns the curves of one column: all finders in grey with one entry in the legend, then the straight paths.
std::vector<plot::PlotCurve> drift_curves(const std::vector<const Json*>& results, const char* column) {
  std::vector<plot::PlotCurve> curves;
  std::size_t straight = 0;
  for (const Json* const result : results) {
    const auto path = result->at("path").get<std::string>();
    const auto step = result->at("step_orbits").get<double>();
    plot::PlotCurve curve;
    if (!path.starts_with("straight"))
      curve = {.name = curves.empty() ? "every finder, step 0.01" : "", .colour = std::nullopt};
    else
      curve = {
          .name = fmt::format("{}, step {:.2g}", path, step), .colour = straight++, .dashed = path == control_path};
    for (const Json& row : result->at("rows"))
      curve.points.push_back({row.at("orbits").get<double>(), row.at(column).get<double>()});
    curves.push_back(curve);
  }
  return curves;
}

void figure1(const FinderStudyData& data, const fs::path& folder) {
  const std::vector<const Json*> results = drift_results(data);
  std::vector<DriftRow> rows;
  for (const Json* const result : results)
    for (const Json& row : result->at("rows"))
      rows.push_back({row.at("orbits"), result->at("path"), result->at("step_orbits"), row.at("mean_guiding_x_r"),
                      row.at("mean_vertical_r"), row.at("collisions_per_particle")});
  files::write_text(folder / "figure1.csv", drift_csv(rows));
  plot::Figure figure{.columns = 2, .width = 1100};
  for (const auto& [column, what] :
       {std::pair("mean_guiding_x_r", "guiding centre"), std::pair("mean_vertical_r", "vertical motion")})
    figure.panels.push_back({.x = {.label = "time (orbits)"},
                             .y = {.label = fmt::format("drift of the mean {} (r)", what)},
                             .curves = drift_curves(results, column)});
  save_figures(figure, folder, "figure1");
}

// Draws the surface distance in a hit, a graze and a miss: relative epicycles with different closest distances.
void figure2(const fs::path& folder) {
  constexpr double end_orbits = 0.06 / two_pi;
  plot::Panel panel{.x = {.label = "time (orbits)", .range = {-end_orbits, end_orbits}},
                    .y = {.label = "d − (r_{1} + r_{2}) (r)", .range = {-1.5, 6.0}},
                    .curves = {{.points = {{-end_orbits, 0.0}, {end_orbits, 0.0}}, .colour = std::nullopt}}};
  const Frequencies f{1.0, 1.0};
  for (const auto& [name, closest] : {std::pair("hit", 0.8), std::pair("graze", 1.97), std::pair("miss", 2.3)}) {
    finders::Pair pair;
    pair.hi = elements_from({{closest, 0.0, 0.0}, {0.0, -120.0, 0.0}}, f, Rotation(f, 0.0));
    const finders::DriftStep step(f, -0.1, 0.1, 10.0);
    const finders::RelativeMotion motion(pair, step);
    plot::PlotCurve curve{.name = name, .colour = panel.curves.size() - 1};
    for (int k = -60; k <= 60; ++k)
      curve.points.push_back({k * 1e-3 / two_pi, motion.at(k * 1e-3).d.norm() - 2.0});
    panel.curves.push_back(curve);
  }
  plot::save_figures({.panels = {panel}}, folder, "figure2");
}

// Returns one curve per finder through value(x, finder).
std::vector<plot::PlotCurve> curves_of_finders(const std::vector<double>& all_x,
                                               const std::function<double(double, const std::string&)>& value) {
  std::vector<plot::PlotCurve> curves;
  for (const std::string& finder : shown_finders()) {
    plot::PlotCurve curve{.name = finder, .colour = curves.size(), .marks = true};
    for (const double x : all_x)
      curve.points.push_back({x, value(x, finder)});
    curves.push_back(curve);
  }
  return curves;
}

void figure4(const FinderStudyData& data, const fs::path& folder) {
  plot::Figure figure{.columns = 2, .width = 1100};
  for (const StudyState& state : data.states)
    figure.panels.push_back({.title = state.name,
                             .x = {.label = "step (orbits)", .log = true},
                             .y = {.label = "processor time for 0.1 orbit (s)", .log = true},
                             .curves = curves_of_finders(data.steps, [&](double step, const std::string& finder) {
                               return data.timed(state.name, step, finder, "cpu_s");
                             })});
  save_figures(figure, folder, "figure4");
}

// Returns the numbers of calls by `field` (iterations or evaluations), as columns: all calls, calls with a contact.
// Calls that end before the loop are left out, as in the paper. Bin `last` collects all larger values.
std::vector<plot::PlotCurve> histogram(const Json& audit, const char* field, std::size_t first, std::size_t last) {
  assert(first <= last);
  std::vector<std::uint64_t> contact(last + 1, 0), all(last + 1, 0);
  for (const auto& [exit, calls] : audit.at("exits").items()) {
    const bool hit = exit == "hit" || exit == "outside";
    if (exit == "overlapping" || exit == "receding")
      continue;
    const Json& bins = calls.at(field);
    for (std::size_t k = first; k < bins.size(); ++k) {
      const auto count = bins[k].get<std::uint64_t>();
      all[std::min(k, last)] += count;
      contact[std::min(k, last)] += hit ? count : 0;
    }
  }
  std::vector<plot::PlotCurve> columns = {{.name = "no contact", .colour = std::nullopt, .columns = true},
                                          {.name = "contact found", .columns = true}};
  for (std::size_t k = first; k <= last; ++k) {
    columns[0].points.push_back({static_cast<double>(k), static_cast<double>(all[k])});
    columns[1].points.push_back({static_cast<double>(k), static_cast<double>(contact[k])});
  }
  return columns;
}

void histograms(const FinderStudyData& data, const fs::path& folder, const std::string& name, const char* field,
                const std::vector<std::string>& finders) {
  const std::string& state = data.states.front().name;
  plot::Figure figure{.width = 800, .panel_height = 160};
  for (const std::string& finder : finders)
    figure.panels.push_back({.title = finder,
                             .x = {.label = field, .range = {0.0, 52.0}},
                             .y = {.label = "calls", .log = true},
                             .curves = histogram(data.audit(state, data.shown_step, finder), field, 1, 51)});
  for (plot::Panel& panel : figure.panels) {
    double most = 1.0;
    for (const plot::PlotPoint& point : panel.curves.front().points)
      most = std::max(most, point.y);
    panel.y.range = {0.5, 2.0 * most};
  }
  save_figures(figure, folder, name);
}

void local_times_figure(const FinderStudyData& data, const fs::path& folder) {
  const auto time = [&](double fraction, const std::string& finder) {
    const std::string job = fmt::format("local/{}/{:.6g}/{}", data.states.front().name, data.shown_step, fraction);
    return data.result(job).at("ns_per_call").at(finder).get<double>();
  };
  const std::vector<plot::PlotCurve> curves = curves_of_finders(data.moved_fractions, time);
  plot::Panel panel{.x = {.label = "fraction of particles with an earlier collision in the step"},
                    .y = {.label = "time per call (ns)"},
                    .curves = curves};
  panel.y.range.low = 0.0;
  for (const plot::PlotCurve& curve : curves)
    for (const plot::PlotPoint& point : curve.points)
      panel.y.range.high = std::max(panel.y.range.high, 1.06 * point.y);
  plot::save_figures({.panels = {panel}, .width = 800}, folder, "local-times");
}

} // namespace

void draw_finder_figures(const FinderStudyData& data) {
  const fs::path folder = data.folder / "figures";
  fs::create_directories(folder);
  render::PictureOptions options;
  options.title = "Clumped by self-gravity, equal sizes";
  options.width = 700;
  assert(data.states.size() == 4 && "equal-early, equal-clumped, power-early, power-clumped");
  render_patch(data.states[1].patch, (folder / "figure3.png").string(), options);
  figure1(data, folder);
  figure2(folder);
  figure4(data, folder);
  histograms(data, folder, "figure5", "iterations", paper_finders);
  histograms(data, folder, "figure6", "evaluations", {"original", "newton-full", "linear-full"});
  local_times_figure(data, folder);
}

} // namespace keeler::study
