// A file's content from its beginning to its end, whatever it is. A pipe or a device may have no size beforehand, no
// writer yet and no end: all that is read has a bound, and a wait can be interrupted. All files that are read whole are
// read here.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include <sys/types.h>

namespace keeler {

/// A file that is being read.
class Source {
public:
  /// A pipe need not have a writer yet. Where it cannot be opened errno says why, here and in read().
  explicit Source(const std::filesystem::path& file);
  ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Of a file on a disk; else 0.
  std::size_t size() const { return size_; }
  /// Whether so many bytes of it may be taken: by what it is, and by the memory that there is.
  bool may_have(std::size_t bytes);
  /// As read(2), of what comes next. Throws Interrupted.
  ssize_t read(std::span<std::byte> into);

private:
  std::size_t most() const;

  const std::filesystem::path file_;
  int number_ = -1;
  bool on_disk_ = true, is_pipe_ = false, begun_ = false;
  std::size_t size_ = 0;
  std::optional<std::size_t> most_;
};

/// Why a file could not be read, from errno.
std::string why_unread();

/// Bytes is a string or a vector of bytes. Nothing where the file cannot be read, or has more than `most` bytes or than
/// may be taken of it (EFBIG); errno says why. Throws Interrupted.
template<class Bytes>
std::optional<Bytes> content_of(const std::filesystem::path& path,
                                std::size_t most = std::numeric_limits<std::size_t>::max()) {
  Source source(path);
  const auto fits = [&](std::size_t bytes) { return bytes <= most && source.may_have(bytes); };
  Bytes content;
  std::size_t have = 0;
  if (fits(source.size()))
    content.resize(std::max<std::size_t>(source.size() + 1, 4096)); // one more: to see the end
  while (!content.empty()) {
    const ssize_t got = source.read(std::as_writable_bytes(std::span(content)).subspan(have));
    if (got < 0) // also for a folder: it opens, and fails here
      return {};
    if (got == 0) {
      content.resize(have);
      return content;
    }
    have += static_cast<std::size_t>(got);
    if (!fits(have))
      break;
    if (have == content.size())
      content.resize(2 * have);
  }
  errno = EFBIG;
  return {};
}

} // namespace keeler
