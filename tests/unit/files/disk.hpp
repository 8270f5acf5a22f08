// Temporary folders and full disks.
#pragma once

#include "draws.hpp"

#include <keeler/files/files.hpp>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/resource.h>

namespace keeler::test {

/// A temporary folder, removed with its content.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "keeler-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
  }

private:
  std::filesystem::path path_;
};

/// During its lifetime no file can grow beyond a size, which looks like a full disk to the writer (also for root).
class SmallDisk {
public:
  explicit SmallDisk(std::size_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &former_);
    rlimit limit = former_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

private:
  void (*handler_)(int);
  rlimit former_ = {};
};

/// Writes without forcing to disk, which would take most of a test's time (ext4 also forces truncated files).
inline void write_quickly(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::remove(file);
  std::ofstream(file, std::ios::binary) << text;
}

/// Replaces a file by damaged copies, truncated at many lengths or with one byte changed at many offsets, and calls
/// `judge` for each. All of the last 200 bytes, which include the seal, are tried; where a sanitizer watches, one in
/// seven.
inline void for_each_damage(const std::filesystem::path& file, std::size_t stride,
                            const std::function<void(const std::string& damage)>& judge) {
  const std::string whole = files::read_text(file);
  const std::size_t stride_in_seal = std::min<std::size_t>(stride, sanitized ? 7 : 1);
  for (std::size_t at = 0; at < whole.size(); at += at + 200 < whole.size() ? stride : stride_in_seal) {
    write_quickly(file, std::string_view(whole).substr(0, at));
    judge("cut at " + std::to_string(at));
    for (const char flip : {'\x01', '\x80'}) {
      std::string changed = whole;
      changed[at] = static_cast<char>(changed[at] ^ flip);
      write_quickly(file, changed);
      judge("changed at " + std::to_string(at));
    }
  }
  write_quickly(file, whole + '\0');
  judge("a byte longer");
  write_quickly(file, whole);
}

} // namespace keeler::test
