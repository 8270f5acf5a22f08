#include <keeler/core/version.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>

namespace version_test {

using namespace keeler;

TEST_CASE("the build knows its version, commit, compiler and flags") {
  const std::string version = program_version();
  CHECK(std::count(version.begin(), version.end(), '.') == 2);
  CHECK(std::isdigit(static_cast<unsigned char>(version.front())));

  const std::string commit = source_commit();
  CHECK((commit == "unknown" || commit.find_first_not_of("0123456789abcdef") >= 40));

  CHECK(build_compiler().find(' ') != std::string::npos);
  // the flag on which the promise of equal bits rests
  CHECK(build_flags().find("-ffp-contract=off") != std::string::npos);
}

} // namespace version_test
