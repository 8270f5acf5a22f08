#include <keeler/core/error_at_hand.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

namespace keeler {
namespace {

// The call that failed without a name was about the working folder.
IoError error_of(const std::filesystem::filesystem_error& error) {
  const std::string why = error.code().message();
  if (error.path1().empty())
    return IoError(fmt::format("the current folder cannot be found ({}); change to one that is there", why));
  return IoError(
      fmt::format("cannot look at '{}': {}; check the path and its permissions", error.path1().string(), why));
}

} // namespace

Error error_at_hand() {
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
    return {ExitCode::run_time, fmt::format("the system refuses what this needs ({}); end other programs, or raise the "
                                            "limit that is met",
                                            error.code().message())};
  } catch (...) {
    return {ExitCode::run_time, "something happened that Keeler does not foresee; it is a fault of the program: please "
                                "report it, with the command and its files"};
  }
}

} // namespace keeler
