// Detects that another program has a file open for writing.
#pragma once

#include <filesystem>

namespace keeler::files {

/// True if another program holds the write lock of a file, as HDF5 (h5py) does while it has the file open for writing.
/// False if the file system has no locks.
bool is_being_written(const std::filesystem::path& file);

/// Message for such a file.
inline constexpr char being_written[] =
    "another program has it open for writing (h5py does so until file.close()); close it there, then try again";

} // namespace keeler::files
