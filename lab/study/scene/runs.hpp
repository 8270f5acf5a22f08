// The runs of a study of a scene: one per seed that evolves the common state, then one per setting and seed.
#pragma once

#include "choices.hpp"

#include <keeler/batch/planned_run.hpp>
#include <keeler/batch/quantities.hpp>
#include <keeler/batch/run_folders.hpp>

#include <functional>
#include <string>
#include <vector>

namespace keeler::study {

/// A study's validated settings, with all defaults filled in.
struct StudyPlan {
  SceneStudyKind kind = SceneStudyKind::step;
  std::string scene_name; ///< for messages
  Scene scene;
  StudyChoices choices;
  bool quick = false;
  std::size_t seeds = 3;
  double grow_orbits = 0.0, orbits = 0.0;
  batch::RunQuantities quantities; ///< measured in each run

  /// Returns the orbit at which measuring begins: a quarter of `orbits`, at least one orbit, is left out, and without a
  /// common state also `grow_orbits`.
  double since() const;
  /// Returns the orbit at which the runs with each setting end.
  double end() const { return orbits + (has_common_start(kind) ? 0.0 : grow_orbits); }
};

/// Validates the settings. Drops choices with too few particles, with a notice. Throws UsageError.
StudyPlan plan_study(const SceneStudySettings& settings);

/// Returns one run per seed that evolves the common state; none if the settings have no common state.
std::vector<batch::PlannedRun> growth_runs(const StudyPlan& plan);

/// Returns the runs of each setting with each seed, from the common states. PlannedRun::point is the setting's index.
/// Precondition: the runs of growth_runs() are finished in `folders`.
std::vector<batch::PlannedRun> setting_runs(const StudyPlan& plan, const batch::RunFolders& folders);

} // namespace keeler::study
