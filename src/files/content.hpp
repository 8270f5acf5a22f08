// A file's content from its beginning to its end, whatever it is: a pipe has no size beforehand.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

namespace keeler {

/// Bytes is a string or a vector of bytes. Nothing where the file cannot be read or has more than `most` bytes; errno
/// says why.
template<class Bytes>
std::optional<Bytes> content_of(const std::filesystem::path& path,
                                std::size_t most = std::numeric_limits<std::size_t>::max()) {
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
  if (!file)
    return {};
  std::error_code no_size;
  const std::size_t size = std::filesystem::file_size(path, no_size);
  if (!no_size && size > most) {
    errno = EFBIG;
    return {};
  }
  Bytes content;
  content.resize(std::max<std::size_t>(no_size ? 0 : size + 1, 4096)); // one more: to see the end
  std::size_t have = 0;
  while (const std::size_t got = std::fread(content.data() + have, 1, content.size() - have, file.get())) {
    have += got;
    if (have > most) {
      errno = EFBIG;
      return {};
    }
    if (have == content.size())
      content.resize(2 * have);
  }
  if (std::ferror(file.get())) // also for a folder: it opens, and fails here
    return {};
  content.resize(have);
  return content;
}

} // namespace keeler
