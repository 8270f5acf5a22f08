// The number of threads of Keeler's loops. No result depends on it, not even in the last bit.
#pragma once

namespace keeler {

/// Upper limit; more threads than any machine has processors would only use memory.
inline constexpr int max_threads = 1024;

/// Sets the number of threads of the following loops (at least 1). The default is OpenMP's. Throws UsageError if count
/// is above max_threads.
void set_threads(int count);
/// Returns the number of threads of loops.
int threads();

} // namespace keeler
