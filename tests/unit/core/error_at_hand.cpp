#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

namespace error_at_hand_test {

using namespace keeler;

namespace {

template<class Exception> Error met(const Exception& exception) {
  try {
    throw exception;
  } catch (...) {
    return error_at_hand();
  }
}

} // namespace

TEST_CASE("errors of Keeler are returned unchanged") {
  CHECK(std::string(met(IoError("cannot write")).what()) == "cannot write");
  CHECK(std::string(IoError(std::string("in 'a\0b\x1b'", 9)).what()) == "in 'a?b?'"); // not cut by a NUL
  CHECK(met(InvariantError("overlap")).code() == ExitCode::invariant);
}

TEST_CASE("exceptions of libraries get messages of Keeler") {
  const auto reason = std::make_error_code(std::errc::no_such_file_or_directory);
  const Error named = met(std::filesystem::filesystem_error("status", "a/b", reason));
  CHECK(named.code() == ExitCode::input_output);
  CHECK(std::string(named.what()) == "cannot look at 'a/b': No such file or directory; check the path and its "
                                     "permissions");
  CHECK(std::string(met(std::filesystem::filesystem_error("current path", reason)).what())
            .starts_with("the current folder"));
  CHECK(std::string(met(std::bad_alloc()).what()) == no_memory);
  CHECK(std::string(met(std::length_error("vector::_M_fill_insert")).what()) == no_memory);
  CHECK(std::string(met(std::system_error(reason, "thread")).what()).starts_with("the system refuses"));
  const Error other = met(std::out_of_range("map::at"));
  CHECK(other.code() == ExitCode::run_time);
  CHECK(std::string(other.what()).find("map::at") == std::string::npos);
  CHECK(std::string(met(7).what()) == other.what());
}

} // namespace error_at_hand_test
