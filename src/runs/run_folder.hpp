// The files of a run's folder: their names, who may write there, and what a resumed run takes back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace keeler {

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

  /// Whether a run gives a file such a name.
  static bool is_own(std::string_view name);

  /// For messages, where nothing of a run is in the folder: "; its runs are in 'sweep/runs'" of a sweep or a study, or
  /// nothing.
  std::string runs_inside() const;

  /// Throws UsageError when the name is taken by a file, or by a folder that holds anything.
  void refuse_if_occupied() const;

  /// Throws IoError when the folder is not there and could not be made, or cannot be written to.
  void require_writable() const;

  /// Makes the folder if it is not there. Throws IoError when it cannot be made.
  void make() const;

  /// Empties the folder for a new run. Throws UsageError when it holds anything and force is not given; with force, the
  /// files of the run that it holds are removed, nothing else. Throws IoError when one stays.
  void claim(bool force) const;

  /// Removes snapshots from this number on: the resumed run makes them again.
  void cut_snapshots(std::int64_t from_number) const;

  /// The same of files of contacts.
  void cut_contacts(std::int64_t from_number) const;

  /// Removes the part of a line that a kill in the middle of its writing left at the end of the log: the next line
  /// would continue it. Throws IoError.
  void cut_log() const;

  /// Removes the summary of what the run was before: it is true no more. Throws IoError.
  void remove_summary() const;

private:
  std::filesystem::path path_;
};

} // namespace keeler
