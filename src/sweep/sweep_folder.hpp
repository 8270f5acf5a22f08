// The folder of a sweep: runs/NAME, an ordinary run's folder each; scenes/NAME.toml, the scene that a run was started
// with; failed/NAME.txt, why a run failed; grid.toml, a copy of the grid; claims; and what tables.hpp writes.
#pragma once

#include "plan.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace keeler {

class SweepFolder {
public:
  explicit SweepFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path run(const std::string& name) const { return path_ / "runs" / name; }
  std::filesystem::path scene(const std::string& name) const { return path_ / "scenes" / (name + ".toml"); }
  std::filesystem::path failure(const std::string& name) const { return path_ / "failed" / (name + ".txt"); }
  std::filesystem::path grid() const { return path_ / "grid.toml"; }
  std::filesystem::path claims() const { return path_ / "claims"; }

  /// Throws UsageError when the name is taken by a file, or by a folder that holds things and no sweep; and when one of
  /// its runs was made with other settings than the plan's.
  void refuse_other_content(const Grid& grid, const Plan& plan) const;

  /// Runs that the folder holds and the plan does not.
  std::size_t runs_beside(const Plan& plan) const;

  /// Makes the folders. Throws IoError.
  void make() const;

  /// Why the run failed when it was last tried; none when it did not.
  std::optional<std::string> failure_of(const std::string& name) const;

private:
  std::filesystem::path path_;
};

} // namespace keeler
