// The stage of the run in a folder, from its files alone: safe while another process writes there.
#pragma once

#include <cstdint>
#include <filesystem>

namespace keeler::runs {

enum class RunStage {
  absent,    ///< the folder is missing or empty
  begun,     ///< no checkpoint yet: it can only be started again
  resumable, ///< has a checkpoint
  finished,  ///< according to its summary
};

/// Throws IoError when the folder cannot be read.
RunStage run_stage(const std::filesystem::path& folder);

/// Returns the step of the last complete row of the series; 0 without one.
std::int64_t last_recorded_step(const std::filesystem::path& folder);

} // namespace keeler::runs
