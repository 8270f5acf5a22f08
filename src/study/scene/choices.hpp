// Which settings a study of a scene compares.
#pragma once

#include <keeler/scene/scene.hpp>
#include <keeler/study/scene/study.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// One setting, as overrides of the scene.
struct StudyChoice {
  std::string name;                   ///< in tables and in the names of folders: "kick-0.004"
  std::vector<std::string> overrides; ///< "KEY=VALUE"
};

struct StudyChoices {
  std::vector<StudyChoice> choices;
  std::optional<std::size_t> reference; ///< the most accurate one; none: the one with the smallest force error
};

/// "step", "kicks", …
std::string name_of(SceneStudyKind kind);

/// Whether all settings of a seed go on from one state; else each has the scene's own start.
bool shares_start(SceneStudyKind kind);

/// Of a checked scene; `quick`: few. Throws UsageError when the scene has nothing of this kind to change.
StudyChoices study_choices(SceneStudyKind kind, const Scene& scene, bool quick);

/// As many whole steps of nearly `step` as make up a kick interval (all in orbits).
struct Kicks {
  double step = 0.0;
  int every = 1;
};

/// Steps no longer than `longest` that divide the interval.
Kicks steps_in(double interval, double longest);

/// Steps of exactly this length, with the kick interval as near to `interval` as whole steps come, at least one.
Kicks kicks_of(double step, double interval);

} // namespace keeler
