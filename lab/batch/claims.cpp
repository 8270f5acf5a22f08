#include <keeler/batch/claims.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <unistd.h>

namespace keeler::batch {
namespace {

// FNV-1a hash, shifted to the range of lock offsets. If two names have one offset, one merely waits for the other.
off_t byte_of(const std::string& name) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : name)
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return static_cast<off_t>(hash >> 2);
}

int set_lock(int descriptor, int command, short type, const std::string& name) {
  struct flock lock = {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte_of(name);
  lock.l_len = 1;
  int result = 0;
  do
    result = fcntl(descriptor, command, &lock);
  while (result != 0 && errno == EINTR);
  return result;
}

} // namespace

Claims::Claims(const std::filesystem::path& file)
    : descriptor_(open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0)
    throw IoError(
        fmt::format("cannot open '{}': {}; name a folder that can be written to", file.string(), std::strerror(errno)));
}

Claims::~Claims() {
  close(descriptor_);
}

bool Claims::take(const std::string& name) {
  return set_lock(descriptor_, F_OFD_SETLK, F_WRLCK, name) == 0 || (errno != EAGAIN && errno != EACCES);
}

void Claims::wait_for(const std::string& name) {
  set_lock(descriptor_, F_OFD_SETLKW, F_WRLCK, name); // fails only on a file system without locks
}

void Claims::release(const std::string& name) {
  set_lock(descriptor_, F_OFD_SETLK, F_UNLCK, name);
}

} // namespace keeler::batch
