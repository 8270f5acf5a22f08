// An HDF5 virtual file driver on our own system calls. HDF5 1.10 does not report errors of H5Fclose on a full disk, so
// this driver records the first failed write, hides it from the library, and reports it in require_sound().
#pragma once

#include "hdf5.hpp"

#include <keeler/files/descriptor.hpp>

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>

namespace keeler::io::hdf5 {

/// The storage of an HDF5 file. The driver shares its ownership while the file is open.
class Disk {
public:
  /// HDF5 uses the first `size` bytes of the file. Precondition: file is not null.
  Disk(std::shared_ptr<files::Descriptor> file, std::uint64_t size) : file_(std::move(file)), size_(size) {
    assert(file_);
  }

  files::Descriptor& file() { return *file_; }
  std::uint64_t size() const { return size_; }
  /// Rethrows the first failure, if any. Nothing was written after it.
  void require_sound() const;

  // Called by the driver; these do not throw.
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Fills `into`, with zeros beyond the end of the file. Returns false on failure.
  bool read(std::uint64_t offset, std::span<std::byte> into) const;
  void resize(std::uint64_t size);

private:
  std::shared_ptr<files::Descriptor> file_;
  std::uint64_t size_;
  std::exception_ptr failure_;
};

/// Creates an empty HDF5 file. It is complete when it was flushed and closed, require_sound() passed, and the library
/// has released the disk.
Handle create_on(const std::shared_ptr<Disk>& disk);
/// Writes everything of a file that the library still has in memory.
void flush(const Handle& file);
/// Opens an HDF5 file for reading.
Handle open_on(const std::shared_ptr<Disk>& disk);

} // namespace keeler::io::hdf5
