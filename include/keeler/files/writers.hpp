// Whether another program has a file open for writing.
#pragma once

#include <filesystem>

namespace keeler {

/// Returns whether another program holds the lock for writing of this file, as HDF5 (h5py) does while it has the file
/// open for that; false where the file system has no locks.
bool is_being_written(const std::filesystem::path& file);

/// What to say of it: "another program has it open for writing …; close it there, then try again".
inline constexpr char being_written[] =
    "another program has it open for writing (h5py does so until file.close()); close it there, then try again";

} // namespace keeler
