// Pipes and devices that are read as files are: anywhere in them, and more than once.
#pragma once

#include <keeler/files/descriptor.hpp>

#include <filesystem>
#include <memory>

namespace keeler {

/// While one lives, what this thread has read of a pipe or a device is kept, and is what open_anywhere() of the same
/// name gives again: what has been read of such a file is gone.
class KeptStreams {
public:
  KeptStreams();
  ~KeptStreams();
  KeptStreams(const KeptStreams&) = delete;
  KeptStreams& operator=(const KeptStreams&) = delete;
};

/// Whether this is a pipe or a device: what is read of it is gone.
bool reads_once(const std::filesystem::path& file);

/// Opens a file for reading anywhere in it. A pipe or a device is read to its end first, into memory. Throws IoError,
/// Interrupted.
std::shared_ptr<Descriptor> open_anywhere(const std::filesystem::path& file);

} // namespace keeler
