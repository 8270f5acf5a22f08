// The settings that a study of a scene compares.
#pragma once

#include <keeler/scene/scene.hpp>
#include <keeler/study/scene/study.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::study {

/// One setting, as overrides of the scene.
struct StudyChoice {
  std::string name;                   ///< in tables and names of folders: "kick-0.004"
  std::vector<std::string> overrides; ///< "KEY=VALUE"
};

struct StudyChoices {
  std::vector<StudyChoice> choices;
  std::optional<std::size_t> reference; ///< the most accurate choice; none: the one with the smallest force error
};

/// Returns the kind as in the command line: "step", "kicks", …
std::string name_of(SceneStudyKind kind);

/// True if all settings of a seed continue from one common state; otherwise each run begins with the scene's initial
/// state.
bool has_common_start(SceneStudyKind kind);

/// Returns the choices for a validated scene, fewer with `quick`. Throws UsageError when the scene has no setting of
/// this kind.
StudyChoices study_choices(SceneStudyKind kind, const Scene& scene, bool quick);

/// A kick interval of a whole number of steps.
struct Kicks {
  double step = 0.0; ///< orbits
  int every = 1;     ///< steps per kick
};

/// Divides `interval` into equal steps no longer than `max_step` (orbits), at most 1000 of them.
/// Precondition: both are positive.
Kicks steps_in(double interval, double max_step);

/// Returns steps of exactly this length with the kick interval nearest to `interval`, 1 to 1000 steps.
/// Precondition: `step` > 0.
Kicks kicks_of(double step, double interval);

} // namespace keeler::study
