// HDF5 files that know whether they are whole: behind the HDF5 content stands a seal of 64 bytes with its length and
// its checksum. HDF5 readers ignore what follows the content; Keeler verifies the seal before HDF5 sees a byte, because
// the library cannot be trusted to survive damaged structures.
#pragma once

#include "hdf5.hpp"

#include <filesystem>

namespace keeler {

enum class Seal {
  required, ///< a file without a seal is an error
  optional  ///< a file without one is taken as it is: tools that change HDF5 files in place drop the seal
};

/// Writes a file built in memory, sealed, as write_file() does.
void write_sealed(const std::filesystem::path& file, const hdf5::Handle& image);

/// Opens a file for reading from a copy in memory. Throws IoError naming the file and what is wrong with it.
hdf5::Handle open_sealed(const std::filesystem::path& file, Seal seal);

} // namespace keeler
