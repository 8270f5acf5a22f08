#include <keeler/batch/run_folders.hpp>

#include <keeler/batch/claims.hpp>
#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/load_parts.hpp>

#include <fmt/format.h>

#include <cassert>
#include <map>
#include <set>
#include <sstream>

namespace keeler::batch {
namespace {

namespace fs = std::filesystem;

using Keys = std::map<std::string, std::string>;

// Returns the keys of a resolved scene, which has one per line.
Keys keys_of(const std::string& resolved) {
  Keys keys;
  std::istringstream lines(resolved);
  std::string section;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find(" = ");
    if (line.starts_with("["))
      section = line.substr(1, line.find(']') - 1) + ".";
    else if (equals != std::string::npos)
      keys[section + line.substr(0, equals)] = line.substr(equals + 3);
  }
  return keys;
}

// Returns "time.end = 20.0 and now has time.end = 30.0"; empty if the keys are equal.
std::string difference(const Keys& old_keys, const Keys& new_keys) {
  const auto words = [](const Keys& keys, const std::string& key) {
    const auto found = keys.find(key);
    return found == keys.end() ? "no " + key : fmt::format("{} = {}", key, found->second);
  };
  Keys all = old_keys;
  all.insert(new_keys.begin(), new_keys.end());
  for (const auto& [key, value] : all)
    if (words(old_keys, key) != words(new_keys, key))
      return fmt::format("{} and now has {}", words(old_keys, key), words(new_keys, key));
  return {};
}

void refuse_changed_run(const PlannedRun& run, const fs::path& folder, const std::string& location) {
  assert(!run.name.empty());
  const fs::path file = folder / "scene.toml";
  std::error_code unknown;
  if (!fs::exists(file, unknown))
    return;
  // Both are resolved by this version of the program: keys that are newer than the run have their defaults.
  Keys old_keys = keys_of(scene::load_stored_scene(file).resolved);
  Keys new_keys = keys_of(scene::parse_stored_scene(run.scene.resolved, file.string()).resolved);
  if (leaves_resting_open(run.scene)) // decided only when its start is read
    new_keys["gravity.resting_contacts"] = old_keys["gravity.resting_contacts"];
  if (const std::string change = difference(old_keys, new_keys); !change.empty())
    throw UsageError(fmt::format("{}: the run {} was made with {} (runs with other settings cannot be in one table); "
                                 "change the setting back, name another folder, or remove '{}' to run it again",
                                 location, run.name, change, folder.string()));
}

} // namespace

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw IoError(fmt::format("cannot make the folder '{}': {}; name another", folder.string(), error.message()));
}

void RunFolders::refuse_changed(std::span<const PlannedRun> runs, const std::string& location) const {
  for (const PlannedRun& planned : runs)
    refuse_changed_run(planned, run(planned.name), location);
}

std::size_t RunFolders::count_other_runs(std::span<const PlannedRun> runs) const {
  std::set<std::string> planned;
  for (const PlannedRun& run : runs)
    planned.insert(run.name);
  std::size_t count = 0;
  std::error_code unknown;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_ / "runs", unknown))
    count += planned.contains(entry.path().filename().string()) ? 0 : 1;
  return count;
}

void RunFolders::make() const {
  make_folder(path_);
  const Claims first(claims()); // first: this file identifies the folder to other programs
  for (const char* const name : {"runs", "scenes", "failed"})
    make_folder(path_ / name);
}

std::optional<std::string> RunFolders::failure_of(const std::string& name) const {
  std::error_code unknown;
  if (!fs::exists(failure(name), unknown))
    return std::nullopt;
  std::string reason = files::read_text(failure(name));
  while (!reason.empty() && reason.back() == '\n')
    reason.pop_back();
  return reason;
}

} // namespace keeler::batch
