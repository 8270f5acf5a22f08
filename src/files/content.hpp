// Reads the whole content of a file, pipe or device. A pipe or a device may have no known size, no writer yet and no
// end, so the amount is limited and waiting can be interrupted. All files that are read whole are read here.
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

namespace keeler::files {

/// A file that is being read.
class Source {
public:
  /// Opens the file; a pipe need not have a writer yet. On failure read() returns -1, and errno has the reason.
  explicit Source(const std::filesystem::path& file);
  ~Source();
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Returns the size of a regular file in bytes; 0 for others.
  std::size_t size() const { return size_; }
  /// True if `bytes` of it may be read, given the kind of file and the free memory.
  bool may_have(std::size_t bytes);
  /// Reads the next bytes, as read(2). Throws Interrupted.
  ssize_t read(std::span<std::byte> into);

private:
  std::size_t max_size() const;

  const std::filesystem::path file_;
  int number_ = -1;
  bool on_disk_ = true, is_pipe_ = false, begun_ = false;
  std::size_t size_ = 0;
  std::optional<std::size_t> max_size_;
};

/// Returns the reason from errno why a file could not be read.
std::string why_unread();

/// Returns the content of a file as Bytes, a string or a vector of bytes. On failure returns nothing and sets errno,
/// EFBIG when there are more than `max_bytes` or than Source::may_have() permits. Throws Interrupted.
template<class Bytes>
std::optional<Bytes> content_of(const std::filesystem::path& path,
                                std::size_t max_bytes = std::numeric_limits<std::size_t>::max()) {
  Source source(path);
  const auto fits = [&](std::size_t bytes) { return bytes <= max_bytes && source.may_have(bytes); };
  Bytes content;
  std::size_t have = 0;
  if (fits(source.size()))
    content.resize(std::max<std::size_t>(source.size() + 1, 4096)); // one more, to detect the end
  while (!content.empty()) {
    const ssize_t got = source.read(std::as_writable_bytes(std::span(content)).subspan(have));
    if (got < 0) // also for a folder, which can be opened but not read
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

} // namespace keeler::files
