// Random access, and repeated reading, of pipes and devices.
#pragma once

#include <keeler/files/descriptor.hpp>

#include <filesystem>
#include <memory>

namespace keeler {

/// During its lifetime, this thread keeps the content that it reads from a pipe or a device, and open_anywhere() of an
/// equal name returns it again: such a file can be read only once.
class KeptStreams {
public:
  KeptStreams();
  ~KeptStreams();
  KeptStreams(const KeptStreams&) = delete;
  KeptStreams& operator=(const KeptStreams&) = delete;
};

/// True for a pipe or a device, which can be read only once.
bool reads_once(const std::filesystem::path& file);

/// Opens a file for random access; reads a pipe or a device to its end first. Throws IoError, Interrupted.
std::shared_ptr<Descriptor> open_anywhere(const std::filesystem::path& file);

} // namespace keeler
