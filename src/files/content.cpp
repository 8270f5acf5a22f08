#include "content.hpp"

#include "waiting.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>

#include <cassert>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace keeler::files {
namespace {

constexpr std::size_t always_allowed_bytes = 1000000; // read without checking the free memory
constexpr std::size_t max_of_device = std::size_t{1} << 26;
constexpr std::size_t max_piece = std::size_t{1} << 26;

// Opens a file. A descriptor of this process is duplicated: a pipe that is opened again would wait for another writer.
int opened(const std::filesystem::path& file) {
  if (reads_once(file))
    if (const std::optional<int> named = descriptor_named(file))
      return fcntl(*named, F_DUPFD_CLOEXEC, 0);
  return ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

} // namespace

bool reads_once(const std::filesystem::path& file) {
  std::error_code none;
  const std::filesystem::file_status status = std::filesystem::status(file, none);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

Source::Source(const std::filesystem::path& file) : file_(file), number_(opened(file)) {
  struct stat status = {};
  if (number_ < 0 || fstat(number_, &status) != 0)
    return;
  on_disk_ = S_ISREG(status.st_mode) || S_ISDIR(status.st_mode);
  is_pipe_ = S_ISFIFO(status.st_mode);
  if (S_ISREG(status.st_mode))
    size_ = static_cast<std::size_t>(status.st_size);
}

Source::~Source() {
  if (number_ >= 0)
    ::close(number_);
}

// A fraction of the free memory: growing buffers are copied, and the parsed content takes memory too.
std::size_t Source::max_size() const {
  if (!on_disk_ && !is_pipe_)
    return max_of_device;
  return static_cast<std::size_t>((on_disk_ ? 0.5 : 0.25) * available_memory());
}

bool Source::may_have(std::size_t bytes) {
  if (bytes <= always_allowed_bytes)
    return true;
  if (!max_size_)
    max_size_ = max_size();
  return bytes <= *max_size_;
}

ssize_t Source::read(std::span<std::byte> into) {
  assert(!into.empty());
  if (number_ < 0)
    return -1;
  if (on_disk_ && begun_)
    throw_if_interrupted();
  begun_ = true;
  for (;;) {
    if (!on_disk_)
      await(number_, POLLIN, file_);
    const ssize_t got = ::read(number_, into.data(), std::min(into.size(), max_piece));
    if (got >= 0 || (errno != EINTR && errno != EAGAIN))
      return got;
  }
}

std::string why_unread() {
  if (errno == EFBIG)
    return "it is too large, or has no end: it is read into memory, up to a fraction of what is free; name a smaller "
           "file, or use a machine or a limit with more";
  return std::strerror(errno);
}

} // namespace keeler::files
