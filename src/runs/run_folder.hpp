// The files of a run's folder: their names, the checks before writing, and the removal of files by a resumed run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace keeler::runs {

class RunFolder {
public:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path scene() const { return path_ / "scene.toml"; }
  std::filesystem::path series() const { return path_ / "series.csv"; }
  std::filesystem::path moonlets() const { return path_ / "moonlets.csv"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path log() const { return path_ / "log.jsonl"; }
  std::filesystem::path impact_speeds() const { return path_ / "impact_speeds.csv"; }
  std::filesystem::path snapshot(std::int64_t number) const;
  std::filesystem::path contacts(std::int64_t number) const;
  std::filesystem::path broken(std::int64_t step) const;
  const std::filesystem::path& path() const { return path_; }

  /// Returns true if a run may give a file this name.
  static bool is_run_file(std::string_view name);

  /// Returns a hint for messages about a folder without a run: "; its runs are in 'sweep/runs'" if it is the folder of
  /// a sweep or a study, else an empty string.
  std::string runs_inside() const;

  /// Throws UsageError when the path is a file, or a folder that is not empty.
  void refuse_if_occupied() const;

  /// Throws IoError when the folder cannot be written to, or is missing and cannot be made.
  void require_writable() const;

  /// Makes the folder if it is missing. Throws IoError when it cannot be made.
  void make() const;

  /// Empties the folder for a new run. Without `force`, throws UsageError when it is not empty; with it, removes the
  /// files of a run and nothing else. Throws IoError when a file cannot be removed.
  void claim(bool force) const;

  /// Removes the snapshots from this number on: the resumed run writes them again.
  void cut_snapshots(std::int64_t from_number) const;

  /// Removes the files of contacts from this number on.
  void cut_contacts(std::int64_t from_number) const;

  /// Removes an incomplete line at the end of the log, left by a kill during its writing. Throws IoError.
  void cut_log() const;

  /// Removes the summary, which is outdated once the run continues. Throws IoError.
  void remove_summary() const;

private:
  std::filesystem::path path_;
};

} // namespace keeler::runs
