#include <keeler/runs/folder_lock.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace keeler {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw IoError(fmt::format("cannot open the folder '{}': {}", folder.string(), std::strerror(errno)));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    return; // a file system without locks does not keep anyone from working
  close(descriptor_);
  throw UsageError(fmt::format("work is going on in '{}' (another process holds the folder); wait for its end or name "
                               "another folder",
                               folder.string()));
}

FolderLock::~FolderLock() {
  close(descriptor_);
}

bool folder_is_held(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return false;
  const bool held = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return held;
}

} // namespace keeler
