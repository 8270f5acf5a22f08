#include "report.hpp"

#include "json_value.hpp"
#include "runs.hpp"
#include "study_folder.hpp"

#include <keeler/core/json_of_files.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/csv.hpp>
#include <keeler/report/document.hpp>
#include <keeler/statistics/scatter.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler {
namespace {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;

std::string text_of(const Json& json, const char* key) {
  return json.at(key).get<std::string>();
}

void introduce(const GravityStudyData& data, Document& document) {
  const auto made = [&](const char* key) { return data.made.at(key); };
  const Json& b = data.bench;
  document.paragraph(fmt::format(
      "{:.0f} particles in a patch of Saturn's A ring with self-gravity wakes, the physics of "
      "`examples/a-ring-wakes`; {:.4g} m by {:.4g} m, shear offset {:.4g} m. Every solver computes all accelerations "
      "with each of its settings. The error is measured on {:.0f} particles, drawn at random, against the sum over "
      "all pairs and periodic images in double precision, relative to the rms acceleration; the error near the edges "
      "on {:.0f} particles within {:g} m of the cell's edges. **Edge pull** is the mean error in the plane near the "
      "worst of the four edges, relative to the rms acceleration in the plane; as the errors of neighbours are "
      "correlated, such means reach half of the rms error anywhere in the cell. **Net force** is |Σ m a| / Σ m |a|. "
      "Times are processor time on one thread, including sorting and tree or mesh building, medians of {:.0f}.",
      of(b, "count"), b.at("box_m")[0].get<double>(), b.at("box_m")[1].get<double>(), of(b, "offset_m"),
      of(b, "sample"), of(b, "edge_sample"), of(b, "edge_width_m"), of(b, "repeats")));
  document.paragraph(fmt::format("Made by `{}` on {} ({}), {}, flags `{}`, commit {}.", made("command"),
                                 made("processor"), made("host"), made("compiler"), made("flags"), made("commit")));
  if (of(b, "count") < 20000)
    document.paragraph("**This is a small study**: it shows that the measurements work; its times are not typical.");
}

void show_front(const GravityStudyData& data, bool with_figures, Document& document) {
  document.heading("Error against cost");
  if (with_figures)
    document.figure(
        data.folder / "figures", "pareto",
        "Error against processor time, one curve per solver. Circles mark the front: no other setting of any "
        "solver is both faster and more accurate.");
  Rows rows = {{"rms error at most", "the fastest setting", "ns per particle", "its rms error", "its 99.9 percentile"}};
  for (const double bound : {1e-2, 5e-3, 2.5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4}) {
    const Json* best = nullptr;
    for (const Json& row : data.bench.at("rows"))
      if (of(row, "error_rms") <= bound && (!best || of(row, "ns_per_particle") < of(*best, "ns_per_particle")))
        best = &row;
    if (best)
      rows.push_back({fmt::format("{:g}", bound), text_of(*best, "solver") + ", " + text_of(*best, "settings"),
                      fmt::format("{:.0f}", of(*best, "ns_per_particle")),
                      fmt::format("{:.1e}", of(*best, "error_rms")), fmt::format("{:.1e}", of(*best, "error_p999"))});
  }
  document.table(rows);
}

void show_settings(const GravityStudyData& data, Document& document) {
  document.heading("Every setting");
  Rows rows = {{"solver", "settings", "ns per particle", "rms", "99.9 %", "x", "y", "z", "near edges", "edge pull",
                "net force"}};
  for (const Json& row : data.bench.at("rows")) {
    Row line = {text_of(row, "solver"), text_of(row, "settings"), fmt::format("{:.0f}", of(row, "ns_per_particle"))};
    for (const char* key :
         {"error_rms", "error_p999", "error_x", "error_y", "error_z", "error_edge", "edge_pull", "net_force"})
      line.push_back(fmt::format("{:.1e}", of(row, key)));
    rows.push_back(line);
  }
  document.table(rows);
}

void show_convergence(const GravityStudyData& data, bool with_figures, Document& document) {
  document.heading("Convergence");
  if (with_figures)
    document.figure(data.folder / "figures", "convergence", "Errors against the convergence parameter.");
  for (const std::string& solver : data.solvers()) {
    const std::vector<Json> rows = data.rows_of(solver);
    if (!text_of(rows.front(), "parameter").empty())
      document.paragraph(fmt::format("`{}`: the rms error goes as the {} to the power {:.1f}, over all settings.",
                                     solver, text_of(rows.front(), "parameter"), convergence_order(rows)));
  }
}

Scatter scatter_in(const std::vector<Json>& runs, const char* quantity) {
  std::vector<double> values;
  for (const Json& run : runs)
    if (!run.at(quantity).is_null())
      values.push_back(of(run, quantity));
  return scatter_of(values);
}

std::string with_scatter(const Scatter& s) {
  if (s.count == 0)
    return "none";
  return s.count == 1 ? fmt::format("{:.3g}", s.mean) : fmt::format("{:.3g} ± {:.2g}", s.mean, s.deviation);
}

Row table_head(const std::string& first) {
  Row head = {first};
  for (const RunQuantity& q : run_quantities())
    head.push_back(q.title);
  return head;
}

void show_run_means(const GravityStudyData& data, Document& document) {
  Rows rows = {table_head("mean ± standard deviation of one run")};
  rows.front().push_back("largest energy residual");
  for (const GravityChoice& choice : gravity_run_choices()) {
    const std::vector<Json>& runs = data.runs.at(run_label(choice));
    Row row = {run_label(choice)};
    for (const RunQuantity& q : run_quantities())
      row.push_back(with_scatter(scatter_in(runs, q.name)));
    double residual = 0.0;
    for (const Json& run : runs)
      residual = std::max(residual, of(run, "energy_residual"));
    row.push_back(fmt::format("{:.0e}", residual));
    rows.push_back(row);
  }
  document.table(rows);
}

void show_verdicts(const GravityStudyData& data, Document& document) {
  Rows rows = {table_head("difference of the means (95 % bound of the scatter)")};
  std::vector<std::string> beyond;
  int compared = 0;
  for (const auto& [label, reference] : gravity_run_comparisons()) {
    Row row = {label + " − " + reference};
    for (const RunQuantity& q : run_quantities()) {
      const MeanDifference d =
          mean_difference(scatter_in(data.runs.at(reference), q.name), scatter_in(data.runs.at(label), q.name));
      if (!d.known()) {
        row.emplace_back("not known");
        continue;
      }
      ++compared;
      row.push_back(fmt::format("{:+.2g} (± {:.2g}): {}", d.difference, d.bound, d.within() ? "within" : "**beyond**"));
      if (!d.within())
        beyond.push_back(fmt::format("{} of {}", q.title, label));
    }
    rows.push_back(row);
  }
  document.table(rows);
  std::string verdict = fmt::format("**Verdict**: {} of {} differences are within the scatter. A difference is beyond "
                                    "it by Student's t at 95 %, so about {:.0f} of them are expected by chance alone.",
                                    compared - static_cast<int>(beyond.size()), compared, 0.05 * compared);
  for (const std::string& name : beyond)
    verdict += " Beyond: " + name + ".";
  document.paragraph(verdict);
}

// Shows the smallest difference that the runs could have detected, per quantity and relative to its mean.
void show_sensitivity(const GravityStudyData& data, Document& document) {
  std::string text =
      "Smaller differences these runs could not detect, in per cent of the mean (the largest bound in a column):";
  for (const RunQuantity& q : run_quantities()) {
    double bound = 0.0;
    for (const auto& [label, reference] : gravity_run_comparisons()) {
      const Scatter first = scatter_in(data.runs.at(reference), q.name);
      const MeanDifference d = mean_difference(first, scatter_in(data.runs.at(label), q.name));
      if (d.known())
        bound = std::max(bound, d.bound / std::fabs(first.mean));
    }
    text += bound > 0.0 ? fmt::format(" {} {:.0f} %;", q.title, 100.0 * bound) : fmt::format(" {} unknown;", q.title);
  }
  text.back() = '.';
  document.paragraph(text);
}

void show_runs(const GravityStudyData& data, Document& document) {
  document.heading("The same physics");
  assert(!data.runs.empty());
  const std::size_t seeds = data.runs.begin()->second.size();
  document.paragraph(fmt::format(
      "Runs of {} particles with identical physics in a square of 2.5 λ_cr, step 1/1000 orbit, with {} seeds each. All "
      "runs of a seed start from one state with wakes, forget it during {:g} orbits, and are measured over {:g} more, "
      "with ten snapshots per orbit. Wakes are measured in the mean autocorrelation. Solvers are compared at one kick "
      "interval, with their default settings. Collisions count when faster than v_cut. The energy residual is the part "
      "of the energy change that kicks, edges and collisions do not explain, over the energy lost in collisions.",
      gravity_run_count(), seeds, 0.25 * data.orbits, data.orbits));
  if (data.orbits < 2.0)
    document.paragraph("**These runs are short**: they show that the measurements work, and are too short for wakes.");
  show_run_means(data, document);
  show_verdicts(data, document);
  show_sensitivity(data, document);
}

} // namespace

std::vector<std::string> GravityStudyData::solvers() const {
  std::vector<std::string> names;
  for (const Json& row : bench.at("rows"))
    if (const std::string name = text_of(row, "solver"); std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return names;
}

std::vector<Json> GravityStudyData::rows_of(const std::string& solver) const {
  std::vector<Json> rows;
  for (const Json& row : bench.at("rows"))
    if (row.at("solver") == solver)
      rows.push_back(row);
  return rows;
}

std::vector<Json> pareto_front(const Json& rows) {
  std::vector<Json> sorted(rows.begin(), rows.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const Json& a, const Json& b) {
    return std::pair(of(a, "ns_per_particle"), of(a, "error_rms")) <
           std::pair(of(b, "ns_per_particle"), of(b, "error_rms"));
  });
  std::vector<Json> front;
  for (const Json& row : sorted)
    if (front.empty() || of(row, "error_rms") < of(front.back(), "error_rms"))
      front.push_back(row);
  return front;
}

double convergence_order(const std::vector<Json>& rows) {
  assert(rows.size() >= 2);
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const Json& row : rows) {
    assert(of(row, "value") > 0.0 && of(row, "error_rms") > 0.0);
    const double u = std::log(of(row, "value")), v = std::log(of(row, "error_rms"));
    n += 1.0, x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

void write_gravity_tables(const GravityStudyData& data) {
  write_text(data.folder / "gravity.csv", csv_of(data.bench.at("rows")));
  Json runs = Json::array();
  for (const GravityChoice& choice : gravity_run_choices())
    for (const Json& run : data.runs.at(run_label(choice)))
      runs.push_back(run);
  write_text(data.folder / "gravity_runs.csv", csv_of(runs));
  Json all = {{"made", data.made}};
  all.update(data.bench);
  all["runs"] = runs;
  write_text(data.folder / "gravity.json", json_text(all, 1) + "\n");
}

void write_gravity_report(const GravityStudyData& data, bool with_figures) {
  Document document("The gravity solvers: error, cost and effect on the physics");
  introduce(data, document);
  show_front(data, with_figures, document);
  show_convergence(data, with_figures, document);
  show_runs(data, document);
  show_settings(data, document);
  write_text(data.folder / "report.md", document.markdown());
  write_text(data.folder / "report.html", document.html());
}

} // namespace keeler
