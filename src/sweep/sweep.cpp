#include <keeler/sweep/sweep.hpp>

#include "claims.hpp"
#include "output.hpp"
#include "sweep_folder.hpp"
#include "tables.hpp"
#include "workers.hpp"

#include <keeler/core/words.hpp>
#include <keeler/files/files.hpp>
#include <keeler/scene/doubts.hpp>

#include <fmt/format.h>

#include <set>

namespace keeler {
namespace {

using Notice = std::function<void(const std::string&)>;

// One program at a time writes what is the folder's and no run's.
class SharedFiles {
public:
  explicit SharedFiles(Claims& claims) : claims_(claims) { claims_.wait_for(name); }
  ~SharedFiles() { claims_.release(name); }
  SharedFiles(const SharedFiles&) = delete;
  SharedFiles& operator=(const SharedFiles&) = delete;

private:
  static constexpr const char* name = "the folder"; // no run's name has a blank
  Claims& claims_;
};

// What the runs would say, each thing once.
void tell_doubts(const Plan& plan, const Notice& notice) {
  std::set<std::string> told;
  const auto tell = [&](const PlannedRun& run, const std::string& text) {
    if (told.insert(text).second)
      notice(fmt::format("note: {} ({})", text, run.name));
  };
  for (const PlannedRun& run : plan.runs) {
    for (const std::string& text : run.scene.notices)
      tell(run, text);
    for (const std::string& text : doubts(run.scene))
      tell(run, text);
  }
}

// The tables of this moment, without those of a former one that they do not replace.
void write_tables(const Grid& grid, const Plan& plan, const SweepFolder& folder, const std::vector<RunRow>& runs,
                  const std::vector<PointRow>& points, const Notice& notice) {
  const Json run_table = runs_as_json(plan, runs), point_table = points_as_json(plan, points);
  if (!run_table.empty())
    write_text(folder.path() / "sweep.csv", csv_with_gaps(run_table));
  if (point_table.empty())
    return;
  write_text(folder.path() / "points.csv", csv_with_gaps(point_table));
  const Figure figure = draw_figure(grid, plan, points, folder);
  if (figure == Figure::no_gnuplot)
    notice("gnuplot is not there, so only the data of the figure are written (Debian: gnuplot-nox)");
  if (figure == Figure::nothing_to_draw && !grid.plot.x.empty())
    notice(fmt::format("no run has {}, so there is no figure; name another y under [plot]", grid.plot.y));
  write_report(grid, plan, runs, points, folder, figure);
}

} // namespace

SweepResult sweep(const SweepSettings& settings, const RunRequests& requests) {
  const Grid grid = read_grid(settings.grid);
  const Plan plan = plan_runs(grid);
  const SweepFolder folder(settings.folder);
  folder.refuse_other_content(grid, plan);
  folder.make();
  Claims claims(folder.claims());
  {
    const SharedFiles lock(claims);
    write_text(folder.grid(), grid.text);
  }
  if (const std::size_t beside = folder.runs_beside(plan); beside > 0)
    settings.notice(fmt::format("note: {} in '{}' that this grid does not have stay as they are and out of the tables",
                                counted(beside, "run"), (folder.path() / "runs").string()));
  if (!settings.tables_only) {
    tell_doubts(plan, settings.notice);
    work_on(plan, folder, claims, {settings.jobs, settings.threads_per_run, settings.progress, settings.notice},
            requests);
  }
  SweepResult result;
  result.runs = plan.runs.size();
  result.stopped = requests.stop;
  if (result.stopped)
    return result;
  const SharedFiles lock(claims);
  const std::vector<RunRow> runs = run_rows(grid, plan, folder);
  const std::vector<PointRow> points = point_rows(plan, runs);
  write_tables(grid, plan, folder, runs, points, settings.notice);
  result.finished = count_of(runs, RunStatus::finished);
  result.failed = count_of(runs, RunStatus::failed);
  result.points = points_as_json(plan, points).dump();
  return result;
}

} // namespace keeler
