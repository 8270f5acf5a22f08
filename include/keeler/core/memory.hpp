// How much memory this process takes.
#pragma once

namespace keeler {

/// The most that it has had resident so far, bytes; NaN where the system does not say.
double peak_memory();

} // namespace keeler
