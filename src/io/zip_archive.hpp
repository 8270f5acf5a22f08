// Zip archives of stored members (not compressed) below 4 GiB, as numpy.savez writes them.
#pragma once

#include <keeler/files/new_file.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace keeler::io {

/// CRC-32 of zip (ISO 3309), piece by piece.
class Crc32 {
public:
  void add(std::span<const std::byte> bytes);
  std::uint32_t value() const { return ~state_; }

private:
  std::uint32_t state_ = 0xFFFFFFFF;
};

/// Returns the members of an archive, in order: names and contents, which are part of `content`. Throws UsageError for
/// compressed members and for damage; `file` begins the message.
std::vector<std::pair<std::string, std::string_view>> zip_members(std::string_view content, const std::string& file);

/// Writes an archive. It appears under its name, complete, in finish(). Throws IoError, Interrupted, and UsageError
/// above 4 GiB.
class ZipWriter {
public:
  explicit ZipWriter(const std::filesystem::path& file) : name_(file.string()), out_(file) {}

  /// Adds a member: its head and its content.
  void add(const std::string& name, std::string_view head, std::span<const std::byte> content);
  void finish();

private:
  void put(std::string_view bytes);

  std::string name_;
  files::NewFile out_;
  std::uint64_t size_ = 0;
  std::string directory_;
  std::uint16_t count_ = 0;
};

} // namespace keeler::io
