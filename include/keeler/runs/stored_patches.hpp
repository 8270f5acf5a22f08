// The snapshots of a file or of a run's folder, for whoever looks at results.
#pragma once

#include <keeler/particles/patch.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace keeler {

/// Snapshots, oldest first, and the title of the scene that made them.
struct StoredPatches {
  std::vector<Patch> patches;
  std::string title;
};

/// A snapshot file gives that snapshot; a run's folder gives those of its last `orbits` orbits, the newest always among
/// them. Throws IoError when there is none.
StoredPatches load_patches(const std::filesystem::path& path, double orbits);

} // namespace keeler
