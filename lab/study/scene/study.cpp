#include <keeler/study/scene/study.hpp>

#include "report.hpp"
#include "study_folder.hpp"

#include <keeler/advice/warnings.hpp>
#include <keeler/core/error.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/runs/folder_lock.hpp>

#include <fmt/format.h>

namespace keeler::study {
namespace {

// Returns the options that identify a study: a folder with others cannot continue. The scene is compared separately,
// with the scenes of the existing runs.
batch::Json options_of(const StudyPlan& plan) {
  batch::Json choices = batch::Json::array();
  for (const StudyChoice& choice : plan.choices.choices)
    choices.push_back(choice.name);
  return {{"study", name_of(plan.kind)},
          {"seeds", plan.seeds},
          {"grow", plan.grow_orbits},
          {"orbits", plan.orbits},
          {"settings", choices}};
}

void report_warnings(const StudyPlan& plan, const SceneStudySettings& settings) {
  for (const std::string& text : plan.scene.notices)
    settings.notice("note: " + text);
  for (const std::string& text : advice::warnings(plan.scene))
    settings.notice("note: " + text);
}

// Carries out the runs of one stage; returns false after a stop request. `watch` runs since the start of the study.
bool carry_out(const std::vector<batch::PlannedRun>& runs, const std::string& stage, const batch::RunFolders& folders,
               batch::Claims& claims, const Stopwatch& watch, const SceneStudySettings& settings,
               const runs::RunRequests& requests) {
  folders.refuse_changed(runs, settings.scene + ":1:1");
  auto work = static_cast<const batch::BatchSettings&>(settings);
  work.progress = [&](Progress progress) {
    progress.what = stage + ": " + progress.what;
    progress.elapsed_s = watch.elapsed();
    settings.progress(progress);
  };
  work_on(runs, folders, claims, work, requests);
  return !requests.stop;
}

void require_states(const std::vector<batch::PlannedRun>& runs, const batch::RunFolders& folders) {
  for (const batch::PlannedRun& run : runs)
    if (const std::optional<std::string> reason = folders.failure_of(run.name))
      throw Error(
          ExitCode::run_time,
          fmt::format("the state of seed {} could not be evolved: {}; correct that, then run the same command again",
                      run.seed, *reason));
}

batch::BatchResult write_results(const StudyPlan& plan, const std::vector<batch::PlannedRun>& runs,
                                 const batch::RunFolders& folders, const std::map<std::string, std::string>& made,
                                 const SceneStudySettings& settings) {
  const std::vector<batch::RunRow> measured = measure_runs(plan, runs, folders);
  const StudyMeans means = means_of(plan.choices, measured, study_numbers(plan));
  write_study_tables(plan, measured, means, folders.path());
  const auto draw = [&] {
    const bool drawn = draw_study_figure(plan, means, folders.path());
    if (!drawn)
      settings.notice("no figure: no setting has the number that it shows");
    return drawn;
  };
  draw_and_report(draw, [&](bool drawn) { write_study_report(plan, measured, means, made, folders.path(), drawn); });
  return result_of(measured);
}

} // namespace

batch::BatchResult study_scene(const SceneStudySettings& settings, const runs::RunRequests& requests) {
  const StudyPlan plan = plan_study(settings);
  std::map<std::string, std::string> made = study_provenance(settings.arguments);
  made["scene"] = settings.scene;
  const batch::Json begun = open_study_folder(settings.folder, options_of(plan), made);
  for (auto& [key, value] : made)
    value = begun.value(key, value);
  const runs::FolderLock lock(settings.folder);
  const batch::RunFolders folders(settings.folder);
  folders.make();
  batch::Claims claims(folders.claims());
  report_warnings(plan, settings);
  double elapsed = 0.0;
  const Stopwatch watch(elapsed);

  const std::vector<batch::PlannedRun> growth = growth_runs(plan);
  if (!growth.empty() && !carry_out(growth, "states", folders, claims, watch, settings, requests))
    return {.stopped = true};
  require_states(growth, folders);
  const std::vector<batch::PlannedRun> runs = setting_runs(plan, folders);
  if (!carry_out(runs, "settings", folders, claims, watch, settings, requests))
    return {.stopped = true};
  return write_results(plan, runs, folders, made, settings);
}

} // namespace keeler::study
