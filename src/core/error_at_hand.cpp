#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <cassert>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

namespace keeler {
namespace {

// An error without a path concerns the working folder.
IoError error_of(const std::filesystem::filesystem_error& error) {
  const std::string why = error.code().message();
  if (error.path1().empty())
    return IoError(fmt::format("the current folder cannot be found ({}); change to one that is there", why));
  return IoError(
      fmt::format("cannot look at '{}': {}; check the path and its permissions", error.path1().string(), why));
}

} // namespace

Error error_at_hand() {
  assert(std::current_exception());
  try {
    throw;
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return {ExitCode::run_time, no_memory};
  } catch (const std::length_error&) {
    return {ExitCode::run_time, no_memory};
  } catch (const std::filesystem::filesystem_error& error) {
    return error_of(error);
  } catch (const std::system_error& error) {
    return {ExitCode::run_time, fmt::format("the system refuses a resource ({}); end other programs, or raise the "
                                            "limit that is reached",
                                            error.code().message())};
  } catch (...) {
    return {ExitCode::run_time, "an unexpected error occurred, which is a fault of the program; please report it, with "
                                "the command and its files"};
  }
}

} // namespace keeler
