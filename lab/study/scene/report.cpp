#include "report.hpp"

#include "study_folder.hpp"
#include "verdict.hpp"

#include <keeler/core/format.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/csv.hpp>
#include <keeler/report/document.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::study {
namespace {

using Table = std::vector<std::vector<std::string>>;

std::string what_changes(const StudyPlan& plan) {
  switch (plan.kind) {
  case SceneStudyKind::step:
    return plan.scene.gravity
               ? "`time.step` varies at the scene's kick interval, rounded to whole steps. A step longer than this "
                 "interval becomes the kick interval. `step-auto` has `time.step = \"auto\"`, which chooses both."
               : "`time.step` varies. `step-auto` has `time.step = \"auto\"`.";
  case SceneStudyKind::kicks:
    return "The kick interval varies, by `gravity.kick_every`, at the scene's step, which is shortened where it does "
           "not divide the interval. `kick-auto` has `time.step = \"auto\"`.";
  case SceneStudyKind::mesh:
    return "Solver and accuracy of self-gravity vary: `fft` with `gravity.force_error`, `tree` with "
           "`gravity.opening_angle`, `mesh` leaves near neighbours out, `direct` sums over all pairs.";
  case SceneStudyKind::box:
    return "Both sides of the box are multiplied by a factor, and the number of particles by its square. Streamlines "
           "and modes of the scene keep their number of waves.";
  case SceneStudyKind::sizes:
    return fmt::format(
        "The size distribution is cut from below at several radii (m), and `equal` has one radius, ⟨r³⟩/⟨r²⟩ of the "
        "scene. The {} and the box do not change.",
        plan.scene.gravity ? "surface density" : "optical depth");
  }
  return {};
}

std::string in_orbits(double orbits) {
  return fmt::format("{:g} orbit{}", orbits, orbits == 1.0 ? "" : "s");
}

std::string how_started(const StudyPlan& plan) {
  if (has_common_start(plan.kind))
    return fmt::format(
        "For each of {} one state evolves during {} from the scene's initial state. All settings continue from the "
        "state of their seed for {} and are measured from orbit {:g} of these. Runs of a seed are compared as if they "
        "were independent. In dense rings collisions make them so; with few collisions runs remain correlated and the "
        "intervals of the differences are wider than necessary.",
        pluralize(plan.seeds, "seed"), in_orbits(plan.grow_orbits), in_orbits(plan.orbits), plan.since());
  return fmt::format(
      "The setting changes the state itself, so there is no common state: each run begins with the scene's "
      "initial state and ends at orbit {:g}; it is measured from orbit {:g}. There are {} per setting.",
      plan.end(), plan.since(), pluralize(plan.seeds, "seed"));
}

void introduce(const StudyPlan& plan, const std::map<std::string, std::string>& made, report::Document& document) {
  document.paragraph(what_changes(plan));
  document.paragraph(how_started(plan));
  document.paragraph(
      "Numbers are means over the seeds, ± half the width of their 95 % confidence interval (Student's t). "
      "Processor time and memory are those of a run on one thread.");
  document.paragraph(made_by(made));
}

std::string with_bound(const statistics::Scatter& scatter) {
  if (scatter.count == 0)
    return "–";
  const double bound = mean_bound(scatter);
  return std::isnan(bound) || bound == 0.0
             ? format_number(scatter.mean, 4)
             : fmt::format("{} ± {}", format_number(scatter.mean, 4), format_number(bound, 2));
}

// True if at least one setting has this number.
bool is_known(const StudyMeans& means, std::size_t number) {
  return std::any_of(means.settings.begin(), means.settings.end(),
                     [&](const SettingMeans& setting) { return setting.scatter[number].count > 0; });
}

// Returns the numbers that the report shows: of physics, or of cost and health.
std::vector<std::size_t> shown(const StudyMeans& means, bool physics) {
  std::vector<std::size_t> numbers;
  for (std::size_t n = 0; n < means.numbers.size(); ++n)
    if (!means.numbers[n].title.empty() && means.numbers[n].compared == physics && is_known(means, n))
      numbers.push_back(n);
  return numbers;
}

// Returns a table with titles and names of settings, to which the caller adds the cells.
Table table_of(const StudyMeans& means, const std::vector<std::size_t>& numbers, const std::string& corner) {
  Table table = {{corner}};
  for (const std::size_t n : numbers)
    table.front().push_back(means.numbers[n].title);
  for (std::size_t s = 0; s < means.settings.size(); ++s)
    table.push_back({fmt::format("`{}`{}", means.settings[s].name, s == means.reference ? " (reference)" : "")});
  return table;
}

Table table_of_means(const StudyMeans& means, bool physics) {
  const std::vector<std::size_t> numbers = shown(means, physics);
  Table table = table_of(means, numbers, "setting");
  for (std::size_t s = 0; s < means.settings.size(); ++s)
    for (const std::size_t n : numbers)
      table[s + 1].push_back(with_bound(means.settings[s].scatter[n]));
  return table;
}

// Returns a difference such as "+0.3 ± 1.2", bold when it is beyond the scatter.
std::string in_percent(const statistics::MeanDifference& d, double reference) {
  assert(reference > 0.0);
  const double difference = 100.0 * d.difference / reference, bound = 100.0 * d.bound / reference;
  return fmt::format("{0}{1:+.{3}f} ± {2:.{3}f}{0}", d.within() ? "" : "**", difference, bound, bound < 0.1 ? 2 : 1);
}

Table table_of_differences(const StudyMeans& means) {
  const std::vector<std::size_t> numbers = shown(means, true);
  Table table = table_of(means, numbers, "% from the reference");
  for (std::size_t s = 0; s < means.settings.size(); ++s)
    for (const std::size_t n : numbers) {
      const statistics::MeanDifference& d = means.settings[s].from_reference[n];
      table[s + 1].push_back(d.known() ? in_percent(d, std::fabs(means.settings[means.reference].scatter[n].mean))
                                       : "–");
    }
  table.erase(table.begin() + 1 + static_cast<std::ptrdiff_t>(means.reference));
  return table;
}

void show_lost_contacts(const StudyPlan& plan, report::Document& document) {
  if (plan.scene.collisions.finder != "certified")
    document.paragraph(fmt::format("The scene's finder is `{}`. A run cannot count the contacts that it missed; "
                                   "`finder_gave_up` and `largest_overlap` of `study.csv` show the consequences, and "
                                   "`keeler study finders` counts them.",
                                   plan.scene.collisions.finder));
}

void show_failed(const std::vector<batch::RunRow>& runs, report::Document& document) {
  Table table = {{"run", "reason"}};
  for (const batch::RunRow& run : runs)
    if (!run.reason.empty())
      table.push_back({run.run->name, run.reason});
  if (table.size() == 1)
    return;
  document.heading("Missing runs");
  document.table(table);
}

} // namespace

void write_study_tables(const StudyPlan& plan, const std::vector<batch::RunRow>& runs, const StudyMeans& means,
                        const std::filesystem::path& folder) {
  files::write_text(folder / "study.csv", report::csv_with_gaps(runs_as_json(plan, runs)));
  files::write_text(folder / "settings.csv", report::csv_with_gaps(means_as_json(means)));
}

void write_study_report(const StudyPlan& plan, const std::vector<batch::RunRow>& runs, const StudyMeans& means,
                        const std::map<std::string, std::string>& made, const std::filesystem::path& folder,
                        bool with_figure) {
  report::Document document(fmt::format("Study of the {} of {}", name_of(plan.kind), plan.scene_name));
  introduce(plan, made, document);
  document.heading("Verdict");
  if (plan.quick)
    document.paragraph(
        "**This is a quick study**: few settings, few seeds, short runs. It shows large errors only; for a choice of "
        "settings, leave out `--quick`.");
  document.paragraph(verdict_text(means));
  if (const std::string missed = sensitivity_text(means); !missed.empty())
    document.paragraph(missed);
  if (with_figure)
    document.figure(
        folder / "figures", "pareto",
        plan.kind == SceneStudyKind::mesh
            ? "Force error against processor time, one point per setting."
            : "Difference from the reference against processor time, one point per setting. At the reference the "
              "interval is that of the mean.");
  document.heading("Cost and health");
  document.table(table_of_means(means, false));
  show_lost_contacts(plan, document);
  document.heading("Physics");
  document.table(table_of_means(means, true));
  document.heading("Differences");
  document.paragraph("Bold differences are beyond the scatter.");
  document.table(table_of_differences(means));
  show_failed(runs, document);
  document.paragraph("`study.csv` has all numbers of each run, `settings.csv` those of each setting.");
  files::write_text(folder / "report.md", document.markdown());
  files::write_text(folder / "report.html", document.html());
}

} // namespace keeler::study
