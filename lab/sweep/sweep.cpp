#include <keeler/sweep/sweep.hpp>

#include "figure.hpp"
#include "tables.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/batch/claims.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/files/files.hpp>
#include <keeler/report/csv.hpp>

#include <fmt/format.h>

#include <cassert>
#include <set>

namespace keeler::sweep {
namespace {

namespace fs = std::filesystem;
using Notice = std::function<void(const std::string&)>;

// Held while writing files of the folder that belong to no run: one program at a time.
class FolderFilesLock {
public:
  explicit FolderFilesLock(batch::Claims& claims) : claims_(claims) { claims_.wait_for(name); }
  ~FolderFilesLock() { claims_.release(name); }
  FolderFilesLock(const FolderFilesLock&) = delete;
  FolderFilesLock& operator=(const FolderFilesLock&) = delete;

private:
  static constexpr const char* name = "the folder"; // differs from every run's name: these have no blank
  batch::Claims& claims_;
};

// Throws if the path is a file, or a folder with other content than a sweep.
void refuse_other_content(const batch::RunFolders& folders) {
  std::error_code unknown;
  const fs::file_status status = fs::status(folders.path(), unknown);
  if (fs::exists(status) && !fs::is_directory(status))
    throw UsageError(fmt::format("'{}' is a file (results go into a folder); name another", folders.path().string()));
  if (!fs::is_directory(status) || fs::is_empty(folders.path(), unknown))
    return;
  // Checked after is_empty(): another program that is making this folder makes the file of claims first.
  if (!fs::exists(folders.claims(), unknown) || fs::exists(folders.path() / "study.json", unknown))
    throw UsageError(fmt::format("'{}' is not empty and holds no sweep; name another folder", folders.path().string()));
}

// Reports the notices and warnings of all runs, each text once.
void report_warnings(const Plan& plan, const Notice& notice) {
  std::set<std::string> reported;
  const auto report = [&](const batch::PlannedRun& run, const std::string& text) {
    if (reported.insert(text).second)
      notice(fmt::format("note: {} ({})", text, run.name));
  };
  for (const batch::PlannedRun& run : plan.runs) {
    for (const std::string& text : run.scene.notices)
      report(run, text);
    for (const std::string& text : advice::warnings(run.scene))
      report(run, text);
  }
}

// Writes the present tables, and removes earlier ones that are not replaced. Returns the reason if the figure failed:
// the tables and the report are written without it.
std::string write_tables(const Grid& grid, const Plan& plan, const batch::RunFolders& folders,
                         const std::vector<batch::RunRow>& runs, const std::vector<batch::PointRow>& points,
                         const Notice& notice) {
  const batch::Json run_table = runs_as_json(grid, plan, runs), point_table = points_as_json(grid, plan, points);
  if (!run_table.empty())
    files::write_text(folders.path() / "sweep.csv", report::csv_with_gaps(run_table));
  if (point_table.empty()) {
    std::error_code absent;
    for (const char* const name : {"points.csv", "report.md", "figure.svg", "figure.png"})
      fs::remove(folders.path() / name, absent);
    return {};
  }
  files::write_text(folders.path() / "points.csv", report::csv_with_gaps(point_table));
  for (const char* const name : {"figure.svg", "figure.png"}) {
    std::error_code absent;
    fs::remove(folders.path() / name, absent);
  }
  bool drawn = false;
  std::string fault;
  try {
    drawn = draw_figure(grid, plan, points, folders);
    if (!drawn && !grid.plot.x.empty())
      notice(fmt::format("no run has {}, so there is no figure; name another y under [plot]", grid.plot.y));
  } catch (const IoError& error) {
    fault = error.what();
  }
  write_report(grid, plan, runs, points, folders, drawn);
  return fault;
}

} // namespace

SweepResult sweep(const SweepSettings& settings, const runs::RunRequests& requests) {
  assert(settings.jobs > 0 && settings.notice);
  const Grid grid = read_grid(settings.grid, settings.quantities, settings.units);
  SweepResult result;
  Plan plan;
  try {
    const Interruptible by_requests(requests.stop);
    plan = plan_runs(grid, settings.progress);
  } catch (const Interrupted&) {
    result.stopped = true;
    return result;
  }
  const batch::RunFolders folders(settings.folder);
  refuse_other_content(folders);
  folders.refuse_changed(plan.runs, grid.file.string() + ":1:1");
  folders.make();
  batch::Claims claims(folders.claims());
  {
    const FolderFilesLock lock(claims);
    files::write_text(folders.path() / "grid.toml", grid.text);
  }
  if (const std::size_t others = folders.count_other_runs(plan.runs); others > 0)
    settings.notice(fmt::format("note: {} in '{}' outside this grid (kept, but not in the tables)",
                                pluralize(others, "run"), (folders.path() / "runs").string()));
  if (!settings.tables_only) {
    result.began = true;
    report_warnings(plan, settings.notice);
    work_on(plan.runs, folders, claims, settings, requests);
  }
  result.stopped = requests.stop;
  if (result.stopped)
    return result;
  const FolderFilesLock lock(claims);
  const std::vector<batch::RunRow> runs =
      run_rows(plan.runs, folders, [&](const batch::PlannedRun& run, const fs::path& folder) {
        return grid.quantities.measure(folder, run.scene, grid.since);
      });
  const std::vector<batch::PointRow> points = point_rows(runs, plan.points.size(), grid.quantities.columns().size());
  static_cast<batch::BatchResult&>(result) = result_of(runs);
  result.figure_fault = write_tables(grid, plan, folders, runs, points, settings.notice);
  result.points = std::make_shared<const batch::Json>(points_as_json(grid, plan, points));
  return result;
}

} // namespace keeler::sweep
