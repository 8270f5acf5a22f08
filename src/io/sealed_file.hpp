// HDF5 files that know whether they are whole: behind the HDF5 content stands a seal of 64 bytes with its length and
// its checksum. HDF5 readers ignore what follows the content; Keeler verifies the seal before HDF5 sees a byte, because
// the library cannot be trusted to survive damaged structures. Where there is no seal, a child process reads.
#pragma once

#include "apart.hpp"
#include "hdf5_disk.hpp"

#include <keeler/files/files.hpp>
#include <keeler/files/kept_streams.hpp>
#include <keeler/files/new_file.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler {

/// What stands behind a content.
std::string seal_of(std::span<const std::byte> content);

/// A sealed file in the making. It is never in memory as a whole. As of write_file(): it takes its name when it is
/// finished, and goes when it is not.
class SealedFile {
public:
  /// Throws IoError, as all calls do; DiskFullError where room is missing.
  explicit SealedFile(const std::filesystem::path& file);

  /// The file, for `work` that writes into it.
  void write(const std::function<void(const hdf5::Handle& root)>& work);
  void finish();

private:
  std::filesystem::path name_;
  NewFile unfinished_;
  std::shared_ptr<hdf5::Disk> disk_;
  std::optional<hdf5::Handle> root_;
};

/// Opens a sealed file for reading where it is, when it is whole. Throws IoError naming the file and what is wrong with
/// it.
hdf5::Handle open_sealed(const std::filesystem::path& file);

/// Whether it can be opened and there is a seal at its end, right or wrong. Throws IoError of a pipe or a device that
/// cannot be read.
bool has_seal(const std::filesystem::path& file);
/// The seal at the end of a file. Throws IoError where there is none.
std::string seal_in(const std::filesystem::path& file);
/// The same file, of which somebody else has found that it is whole and has this seal.
hdf5::Handle open_sealed(const std::filesystem::path& file, const std::string& seal);

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
  const KeptStreams kept; // it is looked at more than once
  if (has_seal(file))
    return read(open_sealed(file));
  const FileContent content = load_content(file);
  return read_apart<Result>("read '" + file.string() + "' as HDF5", limits_for(content.bytes.size()),
                            [&] { return read(open_unsealed(file, content.bytes)); });
}

} // namespace keeler
