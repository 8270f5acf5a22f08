// Starts the threads; threads.hpp uses them.
#pragma once

namespace keeler {

/// Starts threads() threads. Throws Error (run_time) if the system refuses: OpenMP would then abort the program.
void start_threads();

} // namespace keeler
