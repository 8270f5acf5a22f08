// One process at a time works in a run's folder.
#pragma once

#include <filesystem>

namespace keeler {

/// Holds a folder for as long as it lives; the system lets go of it when the process ends, however it ends.
class FolderLock {
public:
  /// Throws UsageError when another process holds the folder, IoError when it cannot be opened.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Throws IoError when the name stands for another folder by now, or for none: what is written under it would not be
  /// beside the rest.
  void require_in_place() const;

private:
  std::filesystem::path folder_;
  int descriptor_;
};

/// Whether a process holds the folder now. False of one that is not there.
bool folder_is_held(const std::filesystem::path& folder);

} // namespace keeler
