#include "run_folder.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>

#include <fmt/format.h>

#include <cassert>

namespace keeler::runs {
namespace fs = std::filesystem;
namespace {

bool is_numbered(std::string_view name, std::string_view prefix, std::string_view ending) {
  if (name.size() <= prefix.size() + ending.size() || !name.starts_with(prefix) || !name.ends_with(ending))
    return false;
  name.remove_prefix(prefix.size());
  name.remove_suffix(ending.size());
  return name.find_first_not_of("0123456789") == name.npos;
}

} // namespace

bool RunFolder::is_run_file(std::string_view name) {
  for (const std::string_view fixed :
       {"scene.toml", "series.csv", "moonlets.csv", "impact_speeds.csv", "summary.json", "log.jsonl"})
    if (name == fixed)
      return true;
  return is_numbered(name, "snap_", ".hdf") || is_numbered(name, "broken_", ".hdf") ||
         is_numbered(name, "checkpoint_", ".h5") || is_numbered(name, "collisions_", ".h5");
}

fs::path RunFolder::snapshot(std::int64_t number) const {
  assert(number >= 0);
  return path_ / fmt::format("snap_{:06}.hdf", number);
}

fs::path RunFolder::contacts(std::int64_t number) const {
  assert(number >= 0);
  return path_ / fmt::format("collisions_{:06}.h5", number);
}

fs::path RunFolder::broken(std::int64_t step) const {
  assert(step >= 0);
  return path_ / fmt::format("broken_{:06}.hdf", step);
}

std::string RunFolder::runs_inside() const {
  const fs::path runs = path_ / "runs";
  return fs::is_directory(runs) ? fmt::format("; its runs are in '{}'", runs.string()) : "";
}

void RunFolder::refuse_if_occupied() const {
  std::error_code unknown; // an unreadable path is reported when the folder is made
  const fs::file_status status = fs::status(path_, unknown);
  if (fs::exists(status) && !fs::is_directory(status))
    throw UsageError(fmt::format("'{}' is a file (results go into a folder); name another", path_.string()));
  if (fs::is_directory(status) && !fs::is_empty(path_, unknown) && !unknown)
    throw UsageError(
        fmt::format("'{}' is not empty (a run never overwrites another); name another folder, continue that "
                    "run with \"keeler resume\", or add --force to replace it",
                    path_.string()));
}

void RunFolder::require_writable() const {
  fs::path nearest = fs::absolute(path_);
  std::error_code unknown;
  while (!fs::exists(nearest, unknown) && nearest != nearest.parent_path())
    nearest = nearest.parent_path();
  files::require_writable_folder(nearest, path_);
}

void RunFolder::make() const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error)
    throw IoError(fmt::format("cannot make the folder '{}': {}", path_.string(), error.message()));
}

void RunFolder::claim(bool force) const {
  if (!force)
    refuse_if_occupied();
  try {
    for (const fs::directory_entry& entry : fs::directory_iterator(path_))
      if (is_run_file(entry.path().filename().string()))
        fs::remove(entry.path());
    files::remove_left_overs(path_, is_run_file);
  } catch (const fs::filesystem_error& error) {
    throw IoError(fmt::format("cannot empty the folder '{}': {}", path_.string(), error.code().message()));
  }
}

void RunFolder::cut_snapshots(std::int64_t from_number) const {
  assert(from_number >= 0);
  std::error_code ignored; // a file that cannot be removed will be replaced
  for (std::int64_t number = from_number; fs::exists(snapshot(number)); ++number)
    fs::remove(snapshot(number), ignored);
}

void RunFolder::cut_contacts(std::int64_t from_number) const {
  assert(from_number >= 0);
  std::error_code ignored; // a file that cannot be removed will be replaced
  for (std::int64_t number = from_number; fs::exists(contacts(number)); ++number)
    fs::remove(contacts(number), ignored);
}

void RunFolder::cut_log() const {
  std::error_code unknown;
  if (!fs::exists(log(), unknown))
    return;
  const std::string text = files::read_text(log());
  if (!text.empty() && text.back() != '\n')
    files::write_text(log(), std::string_view(text).substr(0, text.rfind('\n') + 1));
}

void RunFolder::remove_summary() const {
  std::error_code error;
  fs::remove(summary(), error);
  if (error)
    throw IoError(fmt::format("cannot remove '{}': {}", summary().string(), error.message()));
}

} // namespace keeler::runs
