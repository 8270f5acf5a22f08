#include <keeler/files/descriptor.hpp>

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace keeler::files {
namespace {

[[noreturn]] void fail(const char* verb, const std::filesystem::path& file) {
  const int reason = errno;
  const std::string message = fmt::format("cannot {} '{}': {}", verb, file.string(), std::strerror(reason));
  if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG)
    throw DiskFullError(message);
  throw IoError(message);
}

// Repeats a system call that a signal interrupted.
template<class Call> auto retried(const Call& call) {
  auto result = call();
  while (result < 0 && errno == EINTR)
    result = call();
  return result;
}

// Linux transfers at most 2 GiB per call.
constexpr std::size_t largest_transfer = std::size_t{1} << 30;

} // namespace

// Opens without waiting if the file is a pipe.
Descriptor::Descriptor(const std::filesystem::path& file, int flags) : file_(file) {
  number_ = retried([&] { return ::open(file.c_str(), flags | O_NONBLOCK | O_CLOEXEC, 0666); });
  if (number_ < 0 && errno == ELOOP && (flags & O_NOFOLLOW) != 0)
    throw IoError(fmt::format("cannot open for writing '{}': it is a link, and output does not follow links; replace "
                              "it by the file itself",
                              file.string()));
  if (number_ < 0)
    fail((flags & O_ACCMODE) == O_RDONLY ? "open" : "open for writing", file);
}

Descriptor::Descriptor(int number, const std::filesystem::path& file) : file_(file), number_(number) {
  if (number_ < 0)
    fail("open for writing", file);
}

Descriptor::~Descriptor() {
  if (number_ >= 0)
    ::close(number_);
}

Descriptor::Descriptor(Descriptor&& other) noexcept
    : file_(std::move(other.file_)), number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(number_, other.number_);
  return *this;
}

void Descriptor::write_all(std::span<const std::byte> content) {
  while (!content.empty()) {
    const std::size_t length = std::min(content.size(), largest_transfer);
    const ssize_t written = retried([&] { return ::write(number_, content.data(), length); });
    if (written < 0)
      fail("write", file_);
    content = content.subspan(static_cast<std::size_t>(written));
  }
}

void Descriptor::append_whole(std::span<const std::byte> content) {
  assert((::fcntl(number_, F_GETFL) & O_APPEND) != 0);
  const std::size_t before = size();
  try {
    write_all(content);
  } catch (const IoError&) {
    truncate(before);
    throw;
  }
}

void Descriptor::write_at(std::size_t offset, std::span<const std::byte> content) {
  while (!content.empty()) {
    const std::size_t length = std::min(content.size(), largest_transfer);
    const ssize_t written =
        retried([&] { return ::pwrite(number_, content.data(), length, static_cast<off_t>(offset)); });
    if (written < 0)
      fail("write", file_);
    content = content.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::size_t>(written);
  }
}

std::size_t Descriptor::read_at(std::size_t offset, std::span<std::byte> into) const {
  std::size_t have = 0;
  while (have < into.size()) {
    const std::size_t length = std::min(into.size() - have, largest_transfer);
    const ssize_t got =
        retried([&] { return ::pread(number_, into.data() + have, length, static_cast<off_t>(offset + have)); });
    if (got < 0)
      fail("read", file_);
    if (got == 0)
      break;
    have += static_cast<std::size_t>(got);
  }
  return have;
}

std::string Descriptor::read_all() const {
  std::string content(size(), '\0');
  content.resize(read_at(0, std::as_writable_bytes(std::span(content))));
  return content;
}

std::size_t Descriptor::size() const {
  struct stat status = {};
  if (::fstat(number_, &status) != 0)
    fail("read", file_);
  return static_cast<std::size_t>(status.st_size);
}

void Descriptor::set_mode(unsigned mode) {
  if (::fchmod(number_, mode) != 0)
    fail("set the permissions of", file_);
}

void Descriptor::truncate(std::size_t size) {
  if (retried([&] { return ::ftruncate(number_, static_cast<off_t>(size)); }) != 0)
    fail("cut", file_);
}

void Descriptor::sync() {
  // EINVAL and ENOTSUP: file systems without sync, as some network ones for directories
  if (retried([&] { return ::fsync(number_); }) != 0 && errno != EINVAL && errno != ENOTSUP)
    fail("force to disk", file_);
}

void Descriptor::close() {
  assert(number_ >= 0);
  // not retried: Linux has closed the descriptor even when it reports EINTR
  if (::close(std::exchange(number_, -1)) != 0 && errno != EINTR)
    fail("close", file_);
}

} // namespace keeler::files
