// Converts exceptions of libraries to errors of Keeler; their own messages are not shown to users.
#pragma once

#include <keeler/core/error.hpp>

namespace keeler {

/// Message for failed allocations.
inline constexpr const char* no_memory =
    "there is not enough memory for this; take fewer particles, or a machine or a limit with more";

/// Returns the exception that is being handled, as an error of Keeler. Precondition: called within a catch clause.
Error error_at_hand();

} // namespace keeler
