// Studies of a user's scene: the cost and the effect of one kind of setting. A study runs the scene with several values
// of that setting and several seeds, and compares the means with the means at the most accurate value.
//
// For step, kicks and mesh each seed first evolves one common state, from which all settings of that seed continue. Box
// and sizes change the state itself, so each of their runs begins with the scene's initial state.
//
// docs/manual/commands.md lists the settings, docs/formats.md the files of the folder.
#pragma once

#include <keeler/batch/rows.hpp>
#include <keeler/batch/workers.hpp>

#include <optional>
#include <string>
#include <vector>

namespace keeler::study {

/// The setting that a study changes.
enum class SceneStudyKind {
  step,  ///< time.step at a fixed kick interval
  kicks, ///< the kick interval
  mesh,  ///< solver and accuracy of self-gravity
  box,   ///< the size of the patch
  sizes, ///< the distribution of particle sizes
};

/// Each run is on one thread.
struct SceneStudySettings : batch::BatchSettings {
  SceneStudyKind kind = SceneStudyKind::step;
  std::string scene;                  ///< path of the scene file
  std::vector<std::string> overrides; ///< "KEY=VALUE", applied to the scene
  std::optional<std::size_t> seeds;   ///< at least 2; default 3, quick 2
  std::optional<double> grow_orbits;  ///< to the common state; default 6 with self-gravity, 10 without, quick 1
  std::optional<double> orbits;       ///< of each run after that, at least 1.5; default 6, quick 2
  bool quick = false;                 ///< few settings, seeds and orbits
  std::vector<std::string> arguments; ///< the command line, for provenance
};

/// Carries out the missing runs and writes tables, figure and report. Throws UsageError when the scene has no setting
/// of this kind or the folder holds another study, Error when a common state could not be evolved, and IoError.
batch::BatchResult study_scene(const SceneStudySettings& settings, const runs::RunRequests& requests);

} // namespace keeler::study
