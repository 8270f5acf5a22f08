// Errors that a user can meet, each with the exit code of the program that it ends.
// Bad input throws; a programmer's mistake is an assert, checked in debug builds only.
#pragma once

#include <stdexcept>
#include <string>

namespace keeler {

/// Exit codes of the program.
enum class ExitCode : int {
  done = 0,         ///< all that was asked is done
  run_time = 1,     ///< anything not covered below
  usage = 2,        ///< command line or scene
  invariant = 3,    ///< a physical invariant broke
  input_output = 4, ///< reading or writing failed
  stopped = 75,     ///< stopped early, a valid checkpoint is on disk
};

/// One line for the user: what is wrong, why it is, what to do. What terminals cannot take of it becomes '?'.
class Error : public std::runtime_error {
public:
  Error(ExitCode code, const std::string& message);
  ExitCode code() const { return code_; }

private:
  ExitCode code_;
};

/// The command line or the scene asks for something that is not there or not possible.
struct UsageError : Error {
  explicit UsageError(const std::string& message) : Error(ExitCode::usage, message) {}
};

/// A state that physics does not allow: particles inside each other, an element that is not a number.
struct InvariantError : Error {
  explicit InvariantError(const std::string& message) : Error(ExitCode::invariant, message) {}
};

/// A file could not be read or written.
struct IoError : Error {
  explicit IoError(const std::string& message) : Error(ExitCode::input_output, message) {}
};

/// The disk, a quota or a limit on file size leaves no room.
struct DiskFullError : IoError {
  explicit DiskFullError(const std::string& message) : IoError(message) {}
};

} // namespace keeler
