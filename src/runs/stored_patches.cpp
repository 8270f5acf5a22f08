#include <keeler/runs/stored_patches.hpp>

#include "run_folder.hpp"

#include <keeler/core/error.hpp>
#include <keeler/initial_conditions/possible.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::runs {
namespace fs = std::filesystem;
namespace {

// Orders numbered names of six or more digits: longer names are later.
bool earlier(const fs::path& a, const fs::path& b) {
  const std::string x = a.filename().string(), y = b.filename().string();
  return x.size() != y.size() ? x.size() < y.size() : x < y;
}

constexpr double time_rounding = 1.0 + 1e-9; // factor on times in orbits

io::Snapshot load_snapshot(const fs::path& file) {
  io::Snapshot snapshot = io::read_snapshot(file);
  initial_conditions::require_possible(snapshot.patch, file.string());
  return snapshot;
}

// Appends a snapshot. The first one determines the scene.
void append(StoredPatches& stored, io::Snapshot snapshot, const fs::path& file) {
  if (stored.patches.empty()) {
    const Scene scene = scene::parse_stored_scene(snapshot.meta.scene, file.string());
    stored.title = scene.title;
    stored.gravity = scene.gravity;
    stored.driven = !scene.external_forces.empty();
  }
  stored.patches.push_back(std::move(snapshot.patch));
}

} // namespace

std::vector<fs::path> snapshots_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("snap_") && name.ends_with(".hdf"))
      files.push_back(entry.path());
  }
  if (files.empty())
    throw IoError(
        fmt::format("no snapshot in '{}' (snap_NNNNNN.hdf is missing); name a snapshot file or the folder of a run{}",
                    folder.string(), RunFolder(folder).runs_inside()));
  std::sort(files.begin(), files.end(), earlier);
  return files;
}

StoredPatches load_newest_patch(const fs::path& path) {
  return load_patches(path, 0.0);
}

StoredPatches load_patches(const fs::path& path, double orbits) {
  assert(orbits >= 0.0);
  const std::vector<fs::path> files = fs::is_directory(path) ? snapshots_in(path) : std::vector<fs::path>{path};
  StoredPatches stored;
  for (auto file = files.rbegin(); file != files.rend(); ++file) {
    io::Snapshot snapshot = load_snapshot(*file);
    if (!stored.patches.empty() &&
        snapshot.patch.time_orbits < stored.patches.front().time_orbits - orbits * time_rounding)
      break;
    append(stored, std::move(snapshot), *file);
  }
  std::reverse(stored.patches.begin(), stored.patches.end()); // oldest first
  return stored;
}

StoredPatches load_patches_between(const fs::path& folder, double since, double until) {
  StoredPatches stored;
  const std::vector<fs::path> files = snapshots_in(folder);
  for (auto file = files.rbegin(); file != files.rend(); ++file) { // so that earlier files may be damaged
    io::Snapshot snapshot = load_snapshot(*file);
    if (snapshot.patch.time_orbits * time_rounding < since)
      break;
    const bool first = snapshot.patch.time_orbits <= since * time_rounding;
    if (snapshot.patch.time_orbits <= until * time_rounding)
      append(stored, std::move(snapshot), *file);
    if (first)
      break;
  }
  std::reverse(stored.patches.begin(), stored.patches.end()); // oldest first
  if (stored.patches.empty())
    throw UsageError(fmt::format("no snapshot in '{}' is of orbits {:.6g} to {:.6g}; choose a longer part of the run",
                                 folder.string(), since, until));
  return stored;
}

} // namespace keeler::runs
