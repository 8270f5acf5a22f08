// Edits of HDF5 files through the library: objects that go, come under a wrong type, shape or kind, or point elsewhere.
// The file stays one that the library understands, so that the fuzzer gets to the readers behind it.
#pragma once

#include "draw.hpp"
#include "hdf5.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace keeler::fuzz {

/// The bytes of a file without its seal.
std::vector<std::byte> unsealed(const std::filesystem::path& file);

/// Opens a file from its bytes to be changed, in memory alone.
io::hdf5::Handle open_to_edit(const std::vector<std::byte>& content);

/// Its bytes as they are now.
std::string content_of(const io::hdf5::Handle& file);

/// Makes the edits that an input asks for; one that the library refuses is left out.
void edit(const io::hdf5::Handle& file, Draw& draw);

/// Makes the checksum of a checkpoint that of its fields and its scene as they are now (docs/formats.md); does nothing
/// to another file.
void renew_checksum(const io::hdf5::Handle& file);

} // namespace keeler::fuzz
