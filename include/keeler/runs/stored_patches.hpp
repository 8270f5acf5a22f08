// The snapshots of a file or of a run's folder, for whoever looks at results.
#pragma once

#include <keeler/gravity/solver.hpp>
#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keeler {

/// Snapshots, oldest first, and the title of the scene that made them.
struct StoredPatches {
  std::vector<Patch> patches;
  std::string title;
  std::optional<GravitySettings> gravity; ///< of that scene
  bool driven = false;                    ///< it has other forces besides
};

/// The snapshots of a run's folder, oldest first. Throws IoError when there is none.
std::vector<std::filesystem::path> snapshots_in(const std::filesystem::path& folder);

/// A snapshot file gives that snapshot; a run's folder gives those of its last `orbits` orbits, the newest always among
/// them. Throws IoError when there is none.
StoredPatches load_patches(const std::filesystem::path& path, double orbits);

/// Those of a run's folder from one orbit to another. Throws UsageError when there is none between them.
StoredPatches load_patches_between(const std::filesystem::path& folder, double since, double until);

/// The newest one.
StoredPatches load_newest_patch(const std::filesystem::path& path);

} // namespace keeler
