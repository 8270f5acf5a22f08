// HDF5 files on disk, by our own system calls. HDF5 1.10 reports no error from H5Fclose on a full disk. So its driver
// here hands what it writes to pwrite, and what fails is kept until somebody asks; the library never hears of it.
#pragma once

#include "hdf5.hpp"

#include <keeler/files/descriptor.hpp>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>

namespace keeler::hdf5 {

/// The file under an HDF5 file. It lives as long as the library holds it.
class Disk {
public:
  /// `size`: how many bytes of the file are HDF5's, from its beginning.
  Disk(std::shared_ptr<Descriptor> file, std::uint64_t size) : file_(std::move(file)), size_(size) {}

  Descriptor& file() { return *file_; }
  std::uint64_t size() const { return size_; }
  /// Throws what has failed first, if anything has: from then on nothing was written.
  void require_sound() const;

  // for the driver; these throw nothing
  void write(std::uint64_t place, std::span<const std::byte> bytes);
  /// Zeros stand behind the end. Whether it could be read.
  bool read(std::uint64_t place, std::span<std::byte> into) const;
  void resize(std::uint64_t size);

private:
  std::shared_ptr<Descriptor> file_;
  std::uint64_t size_;
  std::exception_ptr failure_;
};

/// A new, empty HDF5 file. It is whole when it was flushed and closed, require_sound() has passed, and the library
/// holds the disk no more.
Handle create_on(const std::shared_ptr<Disk>& disk);
/// Writes all of a file that the library still has in memory.
void flush(const Handle& file);
/// Opens one for reading.
Handle open_on(const std::shared_ptr<Disk>& disk);

} // namespace keeler::hdf5
