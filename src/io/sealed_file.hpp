// HDF5 files with a seal: 64 bytes after the HDF5 content, with its length and checksum. HDF5 readers ignore what
// follows the content. Keeler verifies the seal before HDF5 reads a byte, because the library may crash on damaged
// structures. A file without a seal is first read in a child process.
#pragma once

#include "child_process.hpp"
#include "hdf5_disk.hpp"

#include <keeler/files/files.hpp>
#include <keeler/files/new_file.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace keeler::io {

/// Returns the seal to append to `content`.
std::string seal_of(std::span<const std::byte> content);

/// Writes a sealed file without holding all of it in memory. The file appears under its name in finish(); without
/// finish() it is removed (see write_file()).
class SealedFile {
public:
  /// All members throw IoError; DiskFullError when the disk is full.
  explicit SealedFile(const std::filesystem::path& file);

  /// Calls work(root), which writes to the file. Precondition: finish() was not called.
  void write(const std::function<void(const hdf5::Handle& root)>& work);
  /// Appends the seal and gives the file its name. Precondition: no handle of an object in it is open.
  void finish();

private:
  std::filesystem::path name_;
  files::NewFile unfinished_;
  std::shared_ptr<hdf5::Disk> disk_;
  std::optional<hdf5::Handle> root_;
};

/// Verifies a sealed file and opens it for reading, not copied to memory. Throws IoError naming the file and the fault.
hdf5::Handle open_sealed(const std::filesystem::path& file);

/// True if the file can be opened and has a seal at its end, valid or not. Throws IoError for a pipe or a device: none
/// can be read in this format.
bool has_seal(const std::filesystem::path& file);
/// Returns the seal at the end of a file, not verified. Throws IoError when there is none.
std::string seal_in(const std::filesystem::path& file);
/// Opens a file that another rank has verified. Throws IoError when its seal is not `seal`.
hdf5::Handle open_sealed(const std::filesystem::path& file, const std::string& seal);

/// Content of a file that may have lost its seal: tools that change HDF5 files in place drop it.
struct FileContent {
  std::vector<std::byte> bytes; ///< without the seal
  bool sealed = false;          ///< they were verified by a seal
};

/// Reads a file into memory. Throws IoError naming the file, also when its seal does not match.
FileContent load_content(const std::filesystem::path& file);

/// Opens content without a seal. The library may crash: try it in a child process first (child_process.hpp). Throws
/// IoError naming the file.
hdf5::Handle open_unsealed(const std::filesystem::path& file, const std::vector<std::byte>& content);

/// Returns read(root of the file). If the file has no valid seal, that is tried in a child process first. Throws
/// IoError naming the file, and what `read` throws.
template<class Read> auto read_content(const std::filesystem::path& file, const Read& read) {
  if (has_seal(file))
    return read(open_sealed(file));
  const FileContent content = load_content(file);
  return read_after_trial("read '" + file.string() + "' as HDF5", limits_for(content.bytes.size()),
                          [&] { return read(open_unsealed(file, content.bytes)); });
}

} // namespace keeler::io
