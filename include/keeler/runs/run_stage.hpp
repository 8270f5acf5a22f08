// How far the run in a folder has come, by its files alone: for whoever looks on while another process may work there.
#pragma once

#include <cstdint>
#include <filesystem>

namespace keeler {

enum class RunStage {
  absent,    ///< no folder, or nothing in it
  begun,     ///< without a checkpoint: it can only begin again
  resumable, ///< with a checkpoint
  finished,  ///< its summary says so
};

/// Throws IoError when the folder cannot be read.
RunStage run_stage(const std::filesystem::path& folder);

/// The step of the last whole row of the series; 0 without one.
std::int64_t steps_on_record(const std::filesystem::path& folder);

} // namespace keeler
