// The checkpoints of a run's folder: checkpoint_NNNNNN.h5, the highest number is the newest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace keeler {

std::filesystem::path checkpoint_path(const std::filesystem::path& folder, std::int64_t number);

/// The checkpoints of a folder, newest first. Throws IoError when the folder cannot be listed.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder);

struct NewestCheckpoint {
  std::filesystem::path path;
  std::vector<std::string> warnings; ///< why each newer one was passed over, newest first
};

/// The newest checkpoint that is whole. Throws IoError when there is none.
NewestCheckpoint newest_valid_checkpoint(const std::filesystem::path& folder);

/// Removes the checkpoints before this one but the `keep` - 1 newest of them, and what interrupted writes of
/// checkpoints left.
void prune_checkpoints(const std::filesystem::path& newest, std::size_t keep = 2);

/// Removes the checkpoints after this one, which a run has passed over: they are of a future that it makes anew.
void remove_later_checkpoints(const std::filesystem::path& newest);

} // namespace keeler
