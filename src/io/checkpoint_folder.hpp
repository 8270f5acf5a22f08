// The checkpoints in the folder of a run: checkpoint_NNNNNN.h5, the highest number is the newest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace keeler::io {

/// Returns FOLDER/checkpoint_NNNNNN.h5. Precondition: number >= 0.
std::filesystem::path checkpoint_path(const std::filesystem::path& folder, std::int64_t number);

/// Lists the checkpoints in a folder, newest first. Throws IoError when the folder cannot be listed.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& folder);

struct NewestCheckpoint {
  std::filesystem::path path;
  std::vector<std::string> warnings; ///< why each newer checkpoint was rejected, newest first
};

/// Finds the newest checkpoint that is not damaged. Throws IoError when there is none.
NewestCheckpoint newest_valid_checkpoint(const std::filesystem::path& folder);

/// Keeps `newest` and the `keep` - 1 checkpoints before it, and removes all older ones, and the temporary files that
/// interrupted writes left. Precondition: keep >= 1.
void prune_checkpoints(const std::filesystem::path& newest, std::size_t keep = 2);

/// Removes the checkpoints after this one, which the resumed run rejected and will compute again.
void remove_later_checkpoints(const std::filesystem::path& newest);

} // namespace keeler::io
