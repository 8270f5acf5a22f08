// Interruptible waiting for the other end of a pipe, or for a device.
#pragma once

#include <filesystem>

namespace keeler::files {

inline constexpr int patience_ms = 50; // between two checks for an interrupt

/// Throws Interrupted, naming the file, if the wait for it has been ended on request.
void require_patience(const std::filesystem::path& file);

/// Waits until the descriptor of `file` is ready for `events`, as poll(2). Throws Interrupted.
void await(int descriptor, short events, const std::filesystem::path& file);

} // namespace keeler::files
