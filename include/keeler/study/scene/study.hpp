// Studies of a user's scene: what one kind of setting costs and changes. A study runs the scene with several values of
// that setting and several seeds, and holds the means against those of the most accurate value.
//
// For step, kicks and mesh each seed first grows one common state, from which all settings of that seed go on; box and
// sizes change the state itself, so each of their runs has the scene's own start.
//
// docs/manual/commands.md has the settings, docs/formats.md the folder.
#pragma once

#include <keeler/core/progress.hpp>
#include <keeler/runs/run.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// The setting that a study changes.
enum class SceneStudyKind {
  step,  ///< time.step, the kick interval held
  kicks, ///< the kick interval
  mesh,  ///< solver and accuracy of self-gravity
  box,   ///< the size of the patch
  sizes, ///< the distribution of particle sizes
};

struct SceneStudySettings {
  SceneStudyKind kind = SceneStudyKind::step;
  std::string scene;                  ///< a file
  std::vector<std::string> overrides; ///< "KEY=VALUE", of the scene
  std::filesystem::path folder;
  std::optional<std::size_t> seeds;      ///< at least 2; none: 3, quick 2
  std::optional<double> grow_orbits;     ///< until the common state; none: 6 with self-gravity, 10 without, quick 1
  std::optional<double> orbits;          ///< of each run from then on, at least 1.5; none: 6, quick 2
  std::vector<std::string> quantities{}; ///< of keeler analyze, as columns besides those of every study
  bool quick = false;                    ///< few settings
  std::size_t jobs = 1;                  ///< runs at once, each a process of one thread
  std::vector<std::string> arguments;    ///< the command line, for provenance
  std::function<void(const Progress&)> progress;
  std::function<void(const std::string&)> notice;
};

/// How the folder stands.
struct SceneStudyResult {
  bool stopped = false;         ///< on request; the same settings go on
  std::size_t failed = 0;       ///< runs that the tables do not have
  std::size_t unmeasurable = 0; ///< those of them that came to their end, but whose files cannot be read
};

/// Carries out the runs that are missing and writes tables, figure and report. Throws UsageError when the scene has
/// nothing of this kind to change or the folder holds something else; Error when no state could be grown; IoError.
SceneStudyResult study_scene(const SceneStudySettings& settings, const RunRequests& requests);

} // namespace keeler
