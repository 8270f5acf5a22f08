#include <keeler/runs/stored_patches.hpp>

#include <keeler/core/error.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/scene/scene.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {
namespace fs = std::filesystem;
namespace {

// Numbered names of six digits or more: longer ones are later.
bool earlier(const fs::path& a, const fs::path& b) {
  const std::string x = a.filename().string(), y = b.filename().string();
  return x.size() != y.size() ? x.size() < y.size() : x < y;
}

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
        fmt::format("no snapshot in '{}' (snap_NNNNNN.hdf is missing); name a snapshot file or the folder of a run",
                    folder.string()));
  std::sort(files.begin(), files.end(), earlier);
  return files;
}

} // namespace

StoredPatches load_patches(const fs::path& path, double orbits) {
  const std::vector<fs::path> files = fs::is_directory(path) ? snapshots_in(path) : std::vector<fs::path>{path};
  StoredPatches stored;
  for (auto file = files.rbegin(); file != files.rend(); ++file) {
    Snapshot snapshot = read_snapshot(*file);
    require_sound(snapshot.patch);
    if (stored.patches.empty())
      stored.title = parse_stored_scene(snapshot.meta.scene, file->string()).title;
    else if (snapshot.patch.time_orbits < stored.patches.front().time_orbits - orbits * (1.0 + 1e-9))
      break;
    stored.patches.push_back(std::move(snapshot.patch));
  }
  std::reverse(stored.patches.begin(), stored.patches.end());
  return stored;
}

} // namespace keeler
