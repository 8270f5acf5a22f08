// HDF5 files that know whether they are whole: behind the HDF5 content stands a seal of 64 bytes with its length and
// its checksum. HDF5 readers ignore what follows the content; Keeler verifies the seal before HDF5 sees a byte, because
// the library cannot be trusted to survive damaged structures. Where there is no seal, a child process reads.
#pragma once

#include "apart.hpp"
#include "hdf5.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace keeler {

/// What stands behind a content.
std::string seal_of(std::span<const std::byte> content);

/// Writes a file built in memory, sealed, as write_file() does.
void write_sealed(const std::filesystem::path& file, const hdf5::Handle& image);

/// Opens a sealed file for reading from a copy in memory. Throws IoError naming the file and what is wrong with it.
hdf5::Handle open_sealed(const std::filesystem::path& file);

/// A file that may have lost its seal: tools that change HDF5 files in place drop it.
struct FileContent {
  std::vector<std::byte> bytes; ///< without the seal
  bool sealed = false;          ///< a seal vouches for them
};

/// Throws IoError naming the file, also where a seal does not match.
FileContent load_content(const std::filesystem::path& file);

/// Opens a content without a seal: only where the library may break (apart.hpp). Throws IoError naming the file.
hdf5::Handle open_unsealed(const std::filesystem::path& file, const std::vector<std::byte>& content);

/// What `read` makes of the HDF5 content of a file: here where a seal vouches for it, else in a child process, whence
/// Result comes as a parcel. Throws IoError naming the file, and what `read` throws.
template<class Result, class Read> Result read_content(const std::filesystem::path& file, const Read& read) {
  FileContent content = load_content(file);
  if (content.sealed) {
    const hdf5::Handle image = hdf5::open_image(content.bytes);
    content = FileContent(); // the library has a copy
    return read(image);
  }
  return read_apart<Result>("read '" + file.string() + "' as HDF5", limits_for(content.bytes.size()),
                            [&] { return read(open_unsealed(file, content.bytes)); });
}

} // namespace keeler
