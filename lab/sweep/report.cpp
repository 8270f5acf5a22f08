#include "tables.hpp"

#include <keeler/core/format.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/document.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keeler::sweep {
namespace {

using Table = std::vector<std::vector<std::string>>;

// Returns the columns shown in the table of points; points.csv has all of them.
std::vector<std::size_t> shown(const Grid& grid) {
  std::vector<std::size_t> columns;
  const auto add = [&](const std::string& name) {
    const std::size_t at = grid.quantities.find(name).value();
    if (std::find(columns.begin(), columns.end(), at) == columns.end())
      columns.push_back(at);
  };
  add(grid.plot.y);
  for (const char* const name :
       {"total_viscosity_r2_omega", "translational_viscosity_r2_omega", "collisional_viscosity_r2_omega",
        "gravitational_viscosity_r2_omega", "energy_balance", "dispersion_x_r_omega", "collisions_per_particle_orbit"})
    add(name);
  return columns;
}

std::string with_error(const std::optional<Estimate>& value) {
  if (!value)
    return "–";
  return std::isfinite(value->error)
             ? fmt::format("{} ± {}", format_number(value->value, 4), format_number(value->error, 2))
             : format_number(value->value, 4);
}

Table table_of_points(const Grid& grid, const Plan& plan, const std::vector<batch::PointRow>& points) {
  std::vector<std::string> header = plan.keys;
  header.insert(header.end(), {"runs", "steady"});
  const std::vector<std::size_t> columns = shown(grid);
  for (const std::size_t column : columns)
    header.push_back("`" + grid.quantities.columns()[column].name + "`");
  Table table = {header};
  for (const batch::PointRow& point : points) {
    if (point.finished == 0)
      continue;
    std::vector<std::string> row;
    for (const GridValue* const value : plan.points[point.point].settings)
      row.push_back(value->label);
    row.insert(row.end(), {fmt::format("{}", point.finished), fmt::format("{}", point.steady)});
    for (const std::size_t column : columns)
      row.push_back(with_error(point.values[column]));
    table.push_back(row);
  }
  return table;
}

} // namespace

void write_report(const Grid& grid, const Plan& plan, const std::vector<batch::RunRow>& runs,
                  const std::vector<batch::PointRow>& points, const batch::RunFolders& folders, bool with_figure) {
  const batch::BatchResult result = result_of(runs);
  report::Document report("Sweep of " + grid.file.filename().string());
  report.paragraph(fmt::format("{} of {}: {} finished, {} failed, {} not finished.", pluralize(result.runs, "run"),
                               pluralize(plan.points.size(), "point"), result.finished, result.failed,
                               result.runs - result.finished - result.failed));
  report.paragraph(fmt::format(
      "Each run is measured {}. Values are means over the seeds, errors the standard errors from the scatter of the "
      "seeds, or for a single seed the error by blocks, if known. `steady` counts the runs that are steady in the "
      "measured part.",
      grid.since ? fmt::format("from orbit {} on", format_number(*grid.since))
                 : "from the orbit where it becomes steady"));
  report.heading("Points");
  report.table(table_of_points(grid, plan, points));
  if (with_figure)
    report.paragraph("![figure](figure.svg)");
  if (result.failed > 0) {
    report.heading("Failed runs");
    Table table = {{"run", "reason"}};
    for (const batch::RunRow& run : runs)
      if (run.status == batch::RunStatus::failed)
        table.push_back({run.run->name, run.reason});
    report.table(table);
  }
  report.paragraph("`points.csv` and `sweep.csv` have all numbers, of points and of runs.");
  files::write_text(folders.path() / "report.md", report.markdown());
}

} // namespace keeler::sweep
