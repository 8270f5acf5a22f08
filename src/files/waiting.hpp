// Waiting for the other end of a pipe, or for a device: such a wait can be interrupted.
#pragma once

#include <filesystem>

namespace keeler {

inline constexpr int patience_ms = 50; // between two looks at whether the work is to be given up

/// Throws Interrupted, with the name of the file that is waited for, when the wait for it is over.
void require_patience(const std::filesystem::path& file);

/// Waits until the file that has this descriptor is ready, `events` as of poll(2). Throws Interrupted.
void await(int descriptor, short events, const std::filesystem::path& file);

} // namespace keeler
