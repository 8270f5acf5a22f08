// Errors reported to users, each with an exit code of the program.
// Invalid input throws; a programming error is an assert, checked in debug builds only.
#pragma once

#include <stdexcept>
#include <string>

namespace keeler {

/// Exit codes of the program.
enum class ExitCode : int {
  done = 0,         ///< everything requested is done
  run_time = 1,     ///< anything not covered below
  usage = 2,        ///< command line or scene
  invariant = 3,    ///< a physical invariant was violated
  input_output = 4, ///< reading or writing failed
  stopped = 75,     ///< stopped early, a valid checkpoint is on disk
};

/// A message of one line: what is wrong, why, what to do. Unprintable characters become '?'.
class Error : public std::runtime_error {
public:
  Error(ExitCode code, const std::string& message); ///< replaces unprintable characters of the message
  ExitCode code() const { return code_; }           ///< of a program that ends by this error

private:
  ExitCode code_;
};

/// The command line or the scene requests something that does not exist or is impossible.
struct UsageError : Error {
  explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {} ///< with that exit code
};

/// An unphysical state: overlapping particles, an element that is not finite.
struct InvariantError : Error {
  explicit InvariantError(const std::string& message) : Error(ExitCode::invariant, message) {} ///< with that exit code
};

/// A file could not be read or written.
struct IoError : Error {
  explicit IoError(const std::string& message) : Error(ExitCode::input_output, message) {} ///< with that exit code
};

/// The disk is full, or a quota or file-size limit is reached.
struct DiskFullError : IoError {
  explicit DiskFullError(const std::string& message) : IoError(message) {} ///< with ExitCode::input_output
};

/// Message for failed allocations.
inline constexpr const char* no_memory =
    "there is not enough memory for this; take fewer particles, or a machine or a limit with more";

/// Returns the exception that is being handled, as an error of Keeler: exceptions of libraries too, whose own messages
/// are not shown to users. Precondition: called within a catch clause.
Error error_at_hand();

} // namespace keeler
