// The folders of many runs below one folder: runs/NAME, an ordinary run's folder each; scenes/NAME.toml, the scene that
// a run was started with; failed/NAME.txt, why a run failed; claims, which processes lock to divide the runs among
// them.
#pragma once

#include <keeler/batch/planned_run.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace keeler {

class RunFolders {
public:
  explicit RunFolders(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path run(const std::string& name) const { return path_ / "runs" / name; }
  std::filesystem::path scene(const std::string& name) const { return path_ / "scenes" / (name + ".toml"); }
  std::filesystem::path failure(const std::string& name) const { return path_ / "failed" / (name + ".txt"); }
  std::filesystem::path claims() const { return path_ / "claims"; }

  /// Throws UsageError when a run was made with other settings than the list's; the message begins with `place`.
  void refuse_changed(std::span<const PlannedRun> runs, const std::string& place) const;

  /// Runs that the folder holds and the list does not.
  std::size_t runs_beside(std::span<const PlannedRun> runs) const;

  /// Makes the folders, and the file of claims before the others. Throws IoError.
  void make() const;

  /// Why the run failed when it was last tried; none when it did not.
  std::optional<std::string> failure_of(const std::string& name) const;

private:
  std::filesystem::path path_;
};

} // namespace keeler
