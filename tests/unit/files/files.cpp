#include <keeler/files/files.hpp>

#include "disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/files/naming_guard.hpp>

#include <doctest/doctest.h>

namespace files_test {

using namespace keeler;
using namespace keeler::test;

TEST_CASE("a file is replaced as a whole and reads back") {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  write_text(file, "first");
  write_text(file, "");
  CHECK(read_text(file).empty());
  const std::string text("with\0zero\n", 10);
  write_text(file, text);
  CHECK(read_text(file) == text);
  CHECK(folder.file_count() == 1);
}

TEST_CASE("a guard that refuses a new file its name leaves none, and the former one") {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "former");
  {
    const NamingGuard guard([] { throw IoError("not here"); });
    CHECK_THROWS_WITH_AS(write_text(folder / "a.txt", "new"), "not here", IoError);
    const NamingGuard inner([] {});
    CHECK_NOTHROW(write_text(folder / "b.txt", "new"));
  }
  CHECK(read_text(folder / "a.txt") == "former");
  CHECK(folder.file_count() == 2);
  write_text(folder / "a.txt", "new");
  CHECK(read_text(folder / "a.txt") == "new");
}

TEST_CASE("a full disk is an error and leaves the former file alone") {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  write_text(file, "former");
  {
    const SmallDisk disk(1000);
    CHECK_THROWS_AS(write_text(file, std::string(1001, 'x')), IoError);
    CHECK_NOTHROW(write_text(folder / "b.txt", std::string(1000, 'x')));
  }
  CHECK(read_text(file) == "former");
  CHECK(folder.file_count() == 2);
}

TEST_CASE("places that cannot be written are errors that name the file and the reason") {
  const TemporaryFolder folder;
  write_text(folder / "file", "");
  CHECK_THROWS_WITH_AS(write_text(folder / "absent/a.txt", "x"), doctest::Contains("No such file"), IoError);
  CHECK_THROWS_WITH_AS(write_text(folder / "file/a.txt", "x"), doctest::Contains("Not a directory"), IoError);
  std::filesystem::create_directories(folder / "taken/below");
  CHECK_THROWS_WITH_AS(write_text(folder / "taken", "x"), doctest::Contains("taken'"), IoError);
  CHECK(folder.file_count() == 2);
}

TEST_CASE("what cannot be read is an error") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(read_text(folder / "absent"), doctest::Contains("absent': No such file"), IoError);
  CHECK_THROWS_AS(read_text(folder.path()), IoError);
}

} // namespace files_test
