// The border to libraries: what they throw becomes an error of Keeler, and no text of theirs reaches a user.
#pragma once

#include <keeler/core/error.hpp>

namespace keeler {

/// What is said where memory is refused.
inline constexpr const char* no_memory =
    "there is not enough memory for this; take fewer particles, or a machine or a limit with more";

/// Returns the exception that is being handled as an error of Keeler. Precondition: within a catch clause.
Error error_at_hand();

} // namespace keeler
