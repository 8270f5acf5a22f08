#include <keeler/core/error.hpp>

#include <keeler/core/printable.hpp>

namespace keeler {

// what() is a C string, which a NUL in a quoted name would truncate.
Error::Error(ExitCode code, const std::string& message) : std::runtime_error(printable_text(message)), code_(code) {}

} // namespace keeler
