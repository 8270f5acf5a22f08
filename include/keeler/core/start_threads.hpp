// The start of the threads, apart from their use (threads.hpp).
#pragma once

namespace keeler {

/// Starts threads() threads now. Throws Error (run_time) where the system refuses: OpenMP would end the program then,
/// in words of its own.
void start_threads();

} // namespace keeler
