#include "report.hpp"

#include "json_value.hpp"

#include <keeler/files/files.hpp>
#include <keeler/report/gnuplot.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> solver_colours = {"#444444", "#c0392b", "#1f77b4", "#2e8b57", "#e67e22"};

// Returns one block of a gnuplot data file with these columns.
std::string data_block(const std::vector<Json>& rows, const std::vector<const char*>& keys) {
  std::string text;
  for (const Json& row : rows) {
    for (const char* key : keys)
      text += fmt::format("{} ", of(row, key));
    text += "\n";
  }
  return text + "\n\n";
}

bool pareto_figure(const GravityStudyData& data, const fs::path& folder) {
  const std::vector<const char*> columns = {"ns_per_particle", "error_rms", "error_p999"};
  std::string blocks = data_block(pareto_front(data.bench.at("rows")), columns);
  std::string curves = "'pareto.dat' index 0 using 1:2 with points pt 6 ps 2.5 lw 2 lc rgb '#999999' title 'front'";
  const std::vector<std::string> solvers = data.solvers();
  for (std::size_t k = 0; k < solvers.size(); ++k) {
    blocks += data_block(data.rows_of(solvers[k]), columns);
    const std::string& colour = solver_colours[k % solver_colours.size()];
    curves += fmt::format(", '' index {0} using 1:2 with linespoints lw 2 pt 7 lc rgb '{1}' title {2}, '' index "
                          "{0} using 1:3 with lines lw 1 dt 2 lc rgb '{1}' title {3}",
                          k + 1, colour, gnuplot_string(solvers[k] + ", rms"), gnuplot_string(solvers[k] + ", 99.9 %"));
  }
  write_text(folder / "pareto.dat", blocks);
  return plot(folder, "pareto",
              "set logscale xy\nset xlabel 'processor time per particle and solve (ns)'\n"
              "set ylabel 'error of the acceleration / rms acceleration'\nset format y '10^{%L}'\nset grid\n"
              "plot " +
                  curves + "\n",
              800, 560);
}

// Draws error against parameter, one panel per solver with a convergence parameter.
bool convergence_figure(const GravityStudyData& data, const fs::path& folder) {
  std::string blocks, panels;
  int count = 0;
  for (const std::string& solver : data.solvers()) {
    const std::vector<Json> rows = data.rows_of(solver);
    const std::string parameter = rows.front().at("parameter").get<std::string>();
    if (parameter.empty())
      continue;
    blocks += data_block(rows, {"value", "error_rms", "error_p999", "edge_pull", "net_force"});
    std::string curves;
    const char* const titles[] = {"rms", "99.9 %", "edge pull", "net force"};
    for (int k = 0; k < 4; ++k)
      curves += fmt::format(
          "{}'convergence.dat' index {} using 1:{} with linespoints lw 2 pt {} lc rgb '{}' title '{}'", k ? ", " : "",
          count, k + 2, k + 5, solver_colours[static_cast<std::size_t>(k) % solver_colours.size()], titles[k]);
    panels += fmt::format("set title {}\nset xlabel {}\nplot {}\n", gnuplot_string(solver), gnuplot_string(parameter),
                          curves);
    ++count;
  }
  write_text(folder / "convergence.dat", blocks);
  return plot(folder, "convergence",
              fmt::format("set multiplot layout 1,{}\nset logscale xy\nset format y '10^{{%L}}'\nset grid\n"
                          "set ylabel 'fraction of the rms acceleration'\nset key bottom right\n{}unset multiplot\n",
                          std::max(1, count), panels),
              600 * std::max(1, count), 480);
}

} // namespace

bool draw_gravity_figures(const GravityStudyData& data) {
  const fs::path folder = data.folder / "figures";
  fs::create_directories(folder);
  const bool drawn = pareto_figure(data, folder);
  return convergence_figure(data, folder) && drawn;
}

} // namespace keeler
