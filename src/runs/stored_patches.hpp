// The snapshots of a file or of a run's folder, as the commands that analyse results read them.
#pragma once

#include <keeler/gravity/solver.hpp>
#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler::runs {

/// Snapshots, oldest first, and the title of the scene that made them.
struct StoredPatches {
  std::vector<Patch> patches;
  std::string title;
  std::optional<GravitySettings> gravity; ///< gravity of that scene
  bool driven = false;                    ///< the scene has external forces
};

/// Returns the snapshots of a run's folder, oldest first. Throws IoError when there is none.
std::vector<std::filesystem::path> snapshots_in(const std::filesystem::path& folder);

/// Loads a snapshot file, or from a run's folder the snapshots of its last `orbits` orbits, always including the
/// newest. Throws IoError when there is none.
StoredPatches load_patches(const std::filesystem::path& path, double orbits);

/// Loads the snapshots of a run's folder from orbit `since` to orbit `until`. Throws UsageError when there is none.
StoredPatches load_patches_between(const std::filesystem::path& folder, double since, double until);

/// Loads a snapshot file, or the newest snapshot of a run's folder.
StoredPatches load_newest_patch(const std::filesystem::path& path);

} // namespace keeler::runs
