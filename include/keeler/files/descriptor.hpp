// An open file of the operating system, with calls that retry what a signal interrupted and notice every failure.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace keeler {

/// Owns a file descriptor. Every member throws IoError "cannot VERB 'FILE': reason"; DiskFullError where room is
/// missing.
class Descriptor {
public:
  /// `flags` as for open(2).
  Descriptor(const std::filesystem::path& file, int flags);
  /// Takes one that open(2) or its like has just returned; below 0 it has failed. Messages name the file.
  Descriptor(int number, const std::filesystem::path& file);
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Writes all of it at the descriptor's position; what a failure leaves half written stays.
  void write_all(std::span<const std::byte> content);
  /// Adds it to a file opened with O_APPEND; after a failure the file ends where it did before.
  void append_whole(std::span<const std::byte> content);
  /// Writes all of it from that byte on, wherever the position is.
  void write_at(std::size_t place, std::span<const std::byte> content);
  /// Fills `into` from that byte on; returns how much of it there is before the file ends.
  std::size_t read_at(std::size_t place, std::span<std::byte> into) const;
  /// All of a file that is open for reading too, whatever has become of its name.
  std::string read_all() const;
  std::size_t size() const;
  int number() const { return number_; }
  /// Sets the permissions, as of chmod(2).
  void set_mode(unsigned mode);
  /// Cuts it there, or fills it with zeros up to there.
  void truncate(std::size_t size);
  /// Forces the content to disk.
  void sync();
  /// Closes now, so that a failure to do so is noticed.
  void close();

private:
  std::filesystem::path file_;
  int number_ = -1;
};

} // namespace keeler
