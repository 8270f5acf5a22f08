// The runs of a study of a scene: the growth of each seed's common state, and the runs with each setting.
#pragma once

#include "choices.hpp"

#include <keeler/batch/planned_run.hpp>
#include <keeler/batch/quantities.hpp>
#include <keeler/batch/run_folders.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler {

/// What a study is of, complete and checked.
struct StudyPlan {
  SceneStudyKind kind = SceneStudyKind::step;
  std::string scene_name; ///< for messages
  Scene scene;
  StudyChoices choices;
  bool quick = false;
  std::size_t seeds = 3;
  double grow_orbits = 0.0, orbits = 0.0;
  RunQuantities quantities; ///< that are measured in each run

  /// Orbit of a run from which on it is measured: a quarter of its orbits, at least one, are left out, with those in
  /// which its own start grew.
  double since() const;
  /// Orbit at which the runs with each setting end.
  double end() const { return orbits + (shares_start(kind) ? 0.0 : grow_orbits); }
};

/// Throws UsageError. Settings that leave too few particles to measure are left out, with a notice.
StudyPlan plan_study(const SceneStudySettings& settings);

/// One a seed; none where settings have starts of their own.
std::vector<PlannedRun> growth_runs(const StudyPlan& plan);

/// Each setting with each seed, from the states that have been grown. The point of a run is its setting.
std::vector<PlannedRun> setting_runs(const StudyPlan& plan, const RunFolders& folders);

} // namespace keeler
