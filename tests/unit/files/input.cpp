#include <keeler/files/input.hpp>

#include "disk.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <thread>

#include <sys/stat.h>

namespace input_test {

using namespace keeler;
using namespace keeler::files;
using namespace keeler::test;

TEST_CASE("an unreadable input file is an error with the location where it was named") {
  const TemporaryFolder folder;
  const std::string absent = folder / "absent";
  CHECK_THROWS_WITH_AS(
      read_input(absent, "s.toml:3:4"),
      ("s.toml:3:4: " + absent + " cannot be read (No such file or directory); check the path and its permissions")
          .c_str(),
      UsageError);
  CHECK_THROWS_WITH_AS(
      read_input(folder.path(), folder.path()),
      (folder.path().string() + ": cannot be read (Is a directory); check the path and its permissions").c_str(),
      UsageError);
}

TEST_CASE("a pipe is read to its end") {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe", text(100000, 'x'); // more than a pipe holds
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::thread writer([&] { std::ofstream(pipe) << text; });
  CHECK(read_input(pipe, pipe) == text);
  writer.join();
}

TEST_CASE("a byte order mark is removed; UTF-16 and endless input are errors") {
  const TemporaryFolder folder;
  const std::string file = folder / "f";
  std::ofstream(file) << "\xef\xbb\xbf"
                      << "1.0\n";
  CHECK(read_input(file, file) == "1.0\n");
  std::ofstream(file) << "\xff\xfe"
                      << "1";
  CHECK_THROWS_WITH_AS(read_input(file, file),
                       (file + ": is a text in UTF-16 (its byte order mark says so); save it as UTF-8").c_str(),
                       UsageError);
  CHECK_THROWS_WITH_AS(read_input("/dev/zero", "/dev/zero"),
                       "/dev/zero: cannot be read (File too large); check the path and its permissions", UsageError);
}

TEST_CASE("rows of numbers are visited with their line numbers") {
  std::vector<std::pair<int, std::vector<double>>> rows;
  for_each_row("# speed  value\n1e-3, 0.9\n\n  -2;.5 # a comment\r\n  \r\n7 1.5x", [&](int line, auto numbers) {
    rows.emplace_back(line, std::vector<double>(numbers.begin(), numbers.end()));
  });
  REQUIRE(rows.size() == 3);
  CHECK(rows[0] == std::pair(2, std::vector{1e-3, 0.9}));
  CHECK(rows[1] == std::pair(4, std::vector{-2.0, 0.5}));
  CHECK(rows[2].first == 6);
  CHECK(rows[2].second[0] == 7.0);
  CHECK(std::isnan(rows[2].second[1]));
}

} // namespace input_test
