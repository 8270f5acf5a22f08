// The folder of many runs: runs/NAME, the folder of a run; scenes/NAME.toml, the scene that it was started with;
// failed/NAME.txt, the reason if it failed; claims, locked by processes to divide the runs among them.
#pragma once

#include <keeler/batch/planned_run.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace keeler::batch {

/// Makes a folder and those above it. Throws IoError.
void make_folder(const std::filesystem::path& folder);

class RunFolders {
public:
  explicit RunFolders(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path run(const std::string& name) const { return path_ / "runs" / name; }
  std::filesystem::path scene(const std::string& name) const { return path_ / "scenes" / (name + ".toml"); }
  std::filesystem::path failure(const std::string& name) const { return path_ / "failed" / (name + ".txt"); }
  std::filesystem::path claims() const { return path_ / "claims"; }

  /// Throws UsageError if an existing run was made with other settings than the planned one. The message begins with
  /// `location`, the position in the user's file.
  void refuse_changed(std::span<const PlannedRun> runs, const std::string& location) const;

  /// Returns the number of runs in the folder that are not planned.
  std::size_t count_other_runs(std::span<const PlannedRun> runs) const;

  /// Makes the folder, then the file of claims, then the other folders. Throws IoError.
  void make() const;

  /// Returns the reason why the last attempt of the run failed; none if it did not.
  std::optional<std::string> failure_of(const std::string& name) const;

private:
  std::filesystem::path path_;
};

} // namespace keeler::batch
