#include <keeler/runs/folder_lock.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace keeler::runs {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : folder_(folder), descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw IoError(fmt::format("cannot open the folder '{}': {}", folder.string(), std::strerror(errno)));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    return; // without support for locks in the file system, no lock is required
  close(descriptor_);
  throw UsageError(fmt::format("'{}' is in use (another process holds the folder); wait until it ends, or name "
                               "another folder",
                               folder.string()));
}

FolderLock::~FolderLock() {
  close(descriptor_);
}

void FolderLock::require_in_place() const {
  struct stat held = {}, named = {};
  if (fstat(descriptor_, &held) == 0 && stat(folder_.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
      held.st_ino == named.st_ino)
    return;
  throw IoError(
      fmt::format("the folder '{}' was moved, replaced or removed while the run wrote to it, so the run stops "
                  "(its files would end up in two places); continue with \"keeler resume\" in the folder's "
                  "new place",
                  folder_.string()));
}

bool folder_is_held(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return false;
  const bool held = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return held;
}

} // namespace keeler::runs
