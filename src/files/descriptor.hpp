// An open file of the operating system; calls are retried after signals and every failure is checked.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace keeler::files {

/// Owns a file descriptor. Every member throws IoError "cannot VERB 'FILE': reason"; DiskFullError on a full disk.
class Descriptor {
public:
  /// `flags` as for open(2).
  Descriptor(const std::filesystem::path& file, int flags);
  /// Owns `number`, the result of open(2) or a similar call; throws by errno if it is below 0. Messages name `file`.
  Descriptor(int number, const std::filesystem::path& file);
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Writes all of `content` at the file position. A failure may leave a part of it in the file.
  void write_all(std::span<const std::byte> content);
  /// Appends `content`; after a failure the file has its former size. Precondition: opened with O_APPEND.
  void append_whole(std::span<const std::byte> content);
  /// Writes all of `content` at `offset` (bytes), independently of the file position.
  void write_at(std::size_t offset, std::span<const std::byte> content);
  /// Reads from `offset` (bytes) on; returns the number of bytes read, fewer than `into` has at the end of the file.
  std::size_t read_at(std::size_t offset, std::span<std::byte> into) const;
  /// Returns the whole content, even if the file was renamed or removed. Precondition: open for reading.
  std::string read_all() const;
  std::size_t size() const;
  int number() const { return number_; }
  /// Sets the permissions, as chmod(2).
  void set_mode(unsigned mode);
  /// Sets the size: removes bytes at the end, or adds zeros.
  void truncate(std::size_t size);
  /// Forces the content to disk.
  void sync();
  /// Closes the file and reports a failure, which the destructor ignores. Precondition: open.
  void close();

private:
  std::filesystem::path file_;
  int number_ = -1;
};

} // namespace keeler::files
