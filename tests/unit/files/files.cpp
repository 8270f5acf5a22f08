#include <keeler/files/files.hpp>

#include "disk.hpp"

#include <keeler/core/interrupt.hpp>
#include <keeler/files/descriptor.hpp>
#include <keeler/files/naming_guard.hpp>

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>

namespace files_test {

using namespace keeler;
using namespace keeler::files;
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

TEST_CASE("a naming guard that throws leaves the former file and no other") {
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

TEST_CASE("a full disk is an error and leaves the former file unchanged") {
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

TEST_CASE("an output that cannot be written is an error that names the file and the reason") {
  const TemporaryFolder folder;
  write_text(folder / "file", "");
  CHECK_THROWS_WITH_AS(write_text(folder / "absent/a.txt", "x"), doctest::Contains("No such file"), IoError);
  CHECK_THROWS_WITH_AS(write_text(folder / "file/a.txt", "x"), doctest::Contains("Not a directory"), IoError);
  std::filesystem::create_directories(folder / "taken/below");
  CHECK_THROWS_WITH_AS(write_text(folder / "taken", "x"), doctest::Contains("taken'"), IoError);
  CHECK(folder.file_count() == 2);
}

TEST_CASE("a file that cannot be read is an error") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(read_text(folder / "absent"), doctest::Contains("absent': No such file"), IoError);
  CHECK_THROWS_AS(read_text(folder.path()), IoError);
}

TEST_CASE("a file that is larger than the memory, or has no end, is an error that names it") {
  const TemporaryFolder folder;
  write_text(folder / "large", "");
  std::filesystem::resize_file(folder / "large", std::uintmax_t{1} << 42);
  CHECK_THROWS_WITH_AS(read_text(folder / "large"), doctest::Contains("large': it is too large"), IoError);
  CHECK_THROWS_WITH_AS(read_file("/dev/zero"), doctest::Contains("/dev/zero': it is too large"), IoError);
}

TEST_CASE("byte order marks and carriage returns of Windows tools are removed") {
  const TemporaryFolder folder;
  write_text(folder / "lines", "\xef\xbb\xbf"
                               "a\r\nb\rc\n\r\n\r");
  CHECK(read_lines(folder / "lines") == "a\nb\rc\n\n\r");
}

TEST_CASE("waiting for a pipe can be interrupted") {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  static std::atomic<bool> over = true;
  {
    const Interruptible by_flag(over);
    CHECK_THROWS_WITH_AS(read_text(pipe), doctest::Contains("waited for '"), Interrupted);
    CHECK_THROWS_WITH_AS(write_text(pipe, "x"), doctest::Contains("waited for '"), Interrupted);
  }
  Interruptible::waits_end_by(over);
  CHECK_THROWS_AS(read_text(pipe), Interrupted);
  CHECK_THROWS_AS(write_text(pipe, "x"), Interrupted);
  write_text(folder / "file", "x");
  CHECK(read_text(folder / "file") == "x"); // without a wait for a writer
  over = false;
  CHECK_THROWS_AS(Descriptor(pipe, O_WRONLY | O_APPEND), IoError);
}

} // namespace files_test
