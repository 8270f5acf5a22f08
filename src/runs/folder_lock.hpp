// An advisory lock on a run's folder: at most one process writes to it.
#pragma once

#include <filesystem>

namespace keeler::runs {

/// Locks a folder during its lifetime. The system releases the lock when the process ends, also when it is killed.
class FolderLock {
public:
  /// Throws UsageError when another process holds the folder, IoError when it cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Throws IoError when the path no longer names the locked folder: files written to that path would be separated from
  /// the earlier ones.
  void require_in_place() const;

private:
  std::filesystem::path folder_;
  int descriptor_;
};

/// Returns true if a process holds the folder's lock now; false if the folder does not exist.
bool folder_is_held(const std::filesystem::path& folder);

} // namespace keeler::runs
