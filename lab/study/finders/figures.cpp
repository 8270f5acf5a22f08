#include "measurements.hpp"
#include "perturbed_ring/perturbed_ring.hpp"
#include "report.hpp"

#include <keeler/core/units.hpp>
#include <keeler/files/files.hpp>
#include <keeler/finders/finder.hpp>
#include <keeler/finders/motion/relative.hpp>
#include <keeler/render/patch_picture.hpp>
#include <keeler/report/gnuplot.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> finder_colours = {"#444444", "#c0392b", "#e67e22", "#1f77b4", "#17a2b8", "#2e8b57"};

std::string style(std::size_t k) {
  return fmt::format("lc rgb '{}' lw 2 pt {}", finder_colours[k % finder_colours.size()], 5 + k);
}

// One curve of Figure 1: a block of figure1.dat and its gnuplot style.
struct DriftCurve {
  std::string title, line_style;
  const Json* result;
};

// Returns the curves in drawing order: all finders in grey with one entry in the key, then the straight paths by step.
std::vector<DriftCurve> drift_curves(const FinderStudyData& data) {
  std::vector<DriftCurve> curves;
  for (const auto& [name, result] : data.results)
    if (name.starts_with("drift/") && !result.at("path").get<std::string>().starts_with("straight"))
      curves.push_back({curves.empty() ? "every finder, step 0.01" : "", "lc rgb '#999999' lw 1", &result});
  for (const char* path : {control_path, straight_path})
    for (const auto& [name, result] : data.results)
      if (name.starts_with("drift/") && result.at("path") == path)
        curves.push_back({fmt::format("{}, step {:.2g}", path, result.at("step_orbits").get<double>()),
                          fmt::format("lc rgb '{}' lw 2{}", finder_colours[curves.size() % finder_colours.size()],
                                      path == std::string(control_path) ? " dt 2" : ""),
                          &result});
  return curves;
}

bool figure1(const FinderStudyData& data, const fs::path& folder) {
  std::vector<DriftRow> all;
  std::string blocks, in_x, in_z;
  const std::vector<DriftCurve> curves = drift_curves(data);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const Json& result = *curves[k].result;
    for (const Json& row : result.at("rows")) {
      all.push_back({row.at("orbits"), result.at("path"), result.at("step_orbits"), row.at("mean_guiding_x_r"),
                     row.at("mean_vertical_r"), row.at("collisions_per_particle")});
      blocks += fmt::format("{} {} {}\n", all.back().orbits, all.back().mean_guiding_x_r, all.back().mean_vertical_r);
    }
    blocks += "\n\n";
    const auto curve = [&](int column) {
      return fmt::format("{}'figure1.dat' index {} using 1:{} with lines {} title {}", k ? ", " : "", k, column,
                         curves[k].line_style, gnuplot_string(curves[k].title));
    };
    in_x += curve(2);
    in_z += curve(3);
  }
  write_text(folder / "figure1.csv", drift_csv(all));
  write_text(folder / "figure1.dat", blocks);
  return plot(
      folder, "figure1",
      fmt::format(
          "set multiplot layout 1,2\nset key bmargin center horizontal samplen 2\nset xlabel 'orbits'\nset grid\n"
          "set ylabel 'drift of the mean guiding centre, r'\nplot {}\n"
          "set ylabel 'drift of the mean vertical motion, r'\nplot {}\nunset multiplot\n",
          in_x, in_z),
      1100, 560);
}

// Draws the surface distance in a hit, a graze and a miss: relative epicycles with different closest distances.
bool figure2(const fs::path& folder) {
  std::string blocks;
  const Frequencies f{1.0, 1.0};
  for (const double closest : {0.8, 1.97, 2.3}) {
    Pair pair;
    pair.hi = elements_from({{closest, 0.0, 0.0}, {0.0, -120.0, 0.0}}, f, Rotation(f, 0.0));
    const DriftStep step(f, -0.1, 0.1, 10.0);
    const RelativeMotion motion(pair, step);
    for (int k = -60; k <= 60; ++k) {
      const double t = k * 1e-3;
      blocks += fmt::format("{} {}\n", t / two_pi, motion.at(t).d.norm() - 2.0);
    }
    blocks += "\n\n";
  }
  write_text(folder / "figure2.dat", blocks);
  return plot(folder, "figure2",
              "set xlabel 'time (orbits)'\nset ylabel 'd − (r_1 + r_2), r'\nset grid\nset yrange [-1.5:6]\n"
              "plot 0 lc rgb '#999999' notitle, for [k=0:2] 'figure2.dat' index k with lines lw 2 "
              "title word('hit graze miss', k+1)\n",
              700, 420);
}

bool figure4(const FinderStudyData& data, const fs::path& folder) {
  std::string script =
      "set multiplot layout 2,2\nset logscale xy\nset xlabel 'step (orbits)'\n"
      "set ylabel 'processor time for 0.1 orbit (s)'\nset grid\nset key bmargin center horizontal samplen 2\n";
  script += fmt::format("set xrange [{}:{}]\n", 0.8 * data.steps.front(), 1.25 * data.steps.back());
  for (const StudyState& state : data.states) {
    std::string table = "# step_orbits";
    for (const std::string& finder : shown_finders())
      table += " " + finder;
    table += "\n";
    for (const double step : data.steps) {
      table += fmt::format("{}", step);
      for (const std::string& finder : shown_finders())
        table += fmt::format(" {}", data.timed(state.name, step, finder, "cpu_s"));
      table += "\n";
    }
    write_text(folder / fmt::format("figure4-{}.dat", state.name), table);
    script += fmt::format("set title '{}'\nplot ", state.name);
    for (std::size_t k = 0; k < shown_finders().size(); ++k)
      script += fmt::format("{}'figure4-{}.dat' using 1:{} with linespoints {} title '{}'", k ? ", " : "", state.name,
                            k + 2, style(k), shown_finders()[k]);
    script += "\n";
  }
  return plot(folder, "figure4", script + "unset multiplot\n", 1100, 900);
}

// Returns a table of the numbers of calls by `field` (iterations or evaluations): calls with a contact, calls without.
// Calls that end before the loop are left out, as in the paper. Bin `last` collects all larger values.
std::string histogram(const Json& audit, const char* field, std::size_t first, std::size_t last) {
  assert(first <= last);
  std::vector<std::uint64_t> contact(last + 1, 0), none(last + 1, 0);
  for (const auto& [exit, calls] : audit.at("exits").items()) {
    const bool hit = exit == "hit" || exit == "outside";
    if (exit == "overlapping" || exit == "receding")
      continue;
    const Json& bins = calls.at(field);
    for (std::size_t k = first; k < bins.size(); ++k)
      (hit ? contact : none)[std::min(k, last)] += bins[k].get<std::uint64_t>();
  }
  std::string table;
  for (std::size_t k = first; k <= last; ++k)
    table += fmt::format("{} {} {}\n", k, contact[k], none[k]);
  return table;
}

bool histograms(const FinderStudyData& data, const fs::path& folder, const std::string& figure, const char* field,
                const std::vector<std::string>& finders) {
  const std::string& state = data.states.front().name;
  std::string script =
      fmt::format("set multiplot layout {},1\nset style fill solid 1.0 noborder\nset boxwidth 0.9\n"
                  "set logscale y\nset yrange [0.5:*]\nset xrange [0:52]\nset ylabel 'calls'\nset grid y\n",
                  finders.size());
  for (const std::string& finder : finders) {
    const std::string file = fmt::format("{}-{}.dat", figure, finder);
    write_text(folder / file, histogram(data.audit(state, data.shown_step, finder), field, 1, 51));
    script += fmt::format("set title '{0}'\nset xlabel '{1}'\nplot '{2}' using 1:($2+$3) with boxes lc rgb '#cccccc' "
                          "title 'no contact', '' using 1:2 with boxes lc rgb '#333333' title 'contact found'\n",
                          finder, field, file);
  }
  return plot(folder, figure, script + "unset multiplot\n", 800, 260 * static_cast<int>(finders.size()));
}

bool local_times_figure(const FinderStudyData& data, const fs::path& folder) {
  const std::string& state = data.states.front().name;
  std::string table;
  for (const double fraction : data.moved_fractions) {
    table += fmt::format("{}", fraction);
    for (const std::string& finder : shown_finders())
      table += fmt::format(" {}", data.result(fmt::format("local/{}/{:.6g}/{}", state, data.shown_step, fraction))
                                      .at("ns_per_call")
                                      .at(finder)
                                      .get<double>());
    table += "\n";
  }
  write_text(folder / "local-times.dat", table);
  std::string script =
      "set xlabel 'fraction of particles with an earlier collision in the step'\nset ylabel 'ns per call'\nset grid\n"
      "set key outside right\nset yrange [0:*]\nplot ";
  for (std::size_t k = 0; k < shown_finders().size(); ++k)
    script += fmt::format("{}'local-times.dat' using 1:{} with linespoints {} title '{}'", k ? ", " : "", k + 2,
                          style(k), shown_finders()[k]);
  return plot(folder, "local-times", script + "\n", 800, 420);
}

} // namespace

bool draw_finder_figures(const FinderStudyData& data) {
  const fs::path folder = data.folder / "figures";
  fs::create_directories(folder);
  PictureOptions options;
  options.title = "Clumped by self-gravity, equal sizes";
  options.width = 700;
  assert(data.states.size() == 4 && "equal-early, equal-clumped, power-early, power-clumped");
  render_patch(data.states[1].patch, (folder / "figure3.png").string(), options);
  bool drawn = figure1(data, folder);
  drawn &= figure2(folder);
  drawn &= figure4(data, folder);
  drawn &= histograms(data, folder, "figure5", "iterations", paper_finders);
  drawn &= histograms(data, folder, "figure6", "evaluations", {"original", "newton-full", "linear-full"});
  drawn &= local_times_figure(data, folder);
  return drawn;
}

} // namespace keeler
