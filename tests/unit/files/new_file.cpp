#include <keeler/files/new_file.hpp>

#include "disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/interrupt.hpp>
#include <keeler/files/files.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace new_file_test {

using namespace keeler;
using namespace keeler::files;
using namespace keeler::test;
namespace fs = std::filesystem;

namespace {

std::span<const std::byte> bytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

// Returns the temporary file of `file`.
fs::path unfinished_beside(const fs::path& file) {
  for (const fs::directory_entry& entry : fs::directory_iterator(file.parent_path()))
    if (unfinished_name(entry.path().filename().string()) == file.filename().string())
      return entry.path();
  return {};
}

fs::perms mode_of(const fs::path& file) {
  return fs::status(file).permissions();
}

} // namespace

TEST_CASE("a temporary name is unique and contains the final name") {
  const TemporaryFolder folder;
  write_text(folder / "a.txt.tmp", "of another program");
  NewFile first(folder / "a.txt");
  const fs::path name = unfinished_beside(folder / "a.txt");
  CHECK(!name.empty());
  CHECK(fs::is_regular_file(name));
  first.write(bytes("first"));
  first.keep();
  CHECK(read_text(folder / "a.txt") == "first");
  CHECK(read_text(folder / "a.txt.tmp") == "of another program");
  CHECK(folder.file_count() == 2);

  CHECK(unfinished_name("a.csv.keeler-0123456789abcdef.tmp") == "a.csv");
  for (const char* const other :
       {"a.csv", "a.csv.tmp", ".keeler-0123456789abcdef.tmp", "a.csv.keeler-0123456789abcde.tmp",
        "a.csv.keeler-0123456789abcdeg.tmp", "a.csv.0123456789abcdef.tmp"})
    CHECK(!unfinished_name(other));
}

TEST_CASE("two writers of one name publish one whole file after the other") {
  const TemporaryFolder folder;
  NewFile first(folder / "a.txt"), second(folder / "a.txt");
  first.write(bytes("first "));
  second.write(bytes("second "));
  first.write(bytes("whole"));
  first.keep();
  CHECK(read_text(folder / "a.txt") == "first whole");
  second.write(bytes("whole"));
  second.keep();
  CHECK(read_text(folder / "a.txt") == "second whole");
  CHECK(folder.file_count() == 1);
}

TEST_CASE("the next writer removes the temporary files that killed writers of the name left, and nothing else") {
  const TemporaryFolder folder;
  const std::string end = ".keeler-0123456789abcdef.tmp";
  write_text(folder / ("a.txt" + end), "torn");
  write_text(folder / ("b.txt" + end), "torn");
  fs::create_symlink(folder / "kept", folder / "a.txt.keeler-0000000000000000.tmp");
  write_text(folder / "kept", "kept");
  const NewFile working(folder / "a.txt");
  const fs::path at_work = unfinished_beside(folder / "a.txt");
  write_text(folder / "a.txt", "new");
  CHECK(!fs::exists(folder / ("a.txt" + end)));
  CHECK(fs::exists(folder / ("b.txt" + end)));
  CHECK(read_text(folder / "kept") == "kept");
  CHECK(fs::exists(at_work));
}

TEST_CASE("a replaced file keeps its permissions; a link is replaced and not followed") {
  const TemporaryFolder folder;
  for (const unsigned mode : {0600u, 0640u, 0444u, 0666u}) {
    const fs::path file = folder / "a.txt";
    write_text(file, "before");
    fs::permissions(file, fs::perms(mode));
    write_text(file, "after");
    CHECK(read_text(file) == "after");
    CHECK(mode_of(file) == fs::perms(mode));
    fs::remove(file);
  }
  const mode_t mask = umask(0022);
  write_text(folder / "new.txt", "");
  umask(mask);
  CHECK(mode_of(folder / "new.txt") == fs::perms(0644));

  write_text(folder / "victim", "victim");
  fs::create_symlink(folder / "victim", folder / "link");
  write_text(folder / "link", "new");
  CHECK(read_text(folder / "victim") == "victim");
  CHECK(!fs::is_symlink(folder / "link"));
}

TEST_CASE("a name of the greatest length can be written") {
  const TemporaryFolder folder;
  const fs::path file = folder / std::string(255, 'n');
  write_text(file, "whole");
  CHECK(read_text(file) == "whole");
  CHECK(folder.file_count() == 1);
}

TEST_CASE("pipes and devices are written to directly") {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe", link = folder / "link";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink(pipe, link);
  CHECK(is_stream(link));
  CHECK(!is_stream(folder / "absent"));
  CHECK(!is_stream(folder.path()));
  const std::string text(200000, 'x'); // more than a pipe holds
  std::string got;
  std::thread reader([&] { got = read_text(pipe); });
  write_text(link, text);
  reader.join();
  CHECK(got == text);
  CHECK(fs::is_fifo(pipe));
  CHECK(fs::is_symlink(link));
  CHECK(folder.file_count() == 2);
  write_text("/dev/null", text);
  CHECK(fs::is_character_file("/dev/null"));
  CHECK_THROWS_AS(write_text("/dev/full", text), DiskFullError);
  CHECK_THROWS_WITH_AS(refuse_stream(link, "HDF5"), doctest::Contains("link' cannot take HDF5"), UsageError);
}

TEST_CASE("descriptors of this process have names, and writing continues at their position") {
  const TemporaryFolder folder;
  const int number = open((folder / "a.txt").c_str(), O_RDWR | O_CREAT, 0600);
  REQUIRE(number > 2);
  const std::string name = "/dev/fd/" + std::to_string(number);
  CHECK(descriptor_named("/dev/stdout") == 1);
  CHECK(descriptor_named(name) == number);
  fs::create_symlink(name, folder / "link");
  CHECK(descriptor_named(folder / "link") == number);
  CHECK(!descriptor_named(folder / "a.txt"));
  CHECK(!descriptor_named("1"));
  write_text(name, "first ");
  write_text(folder / "link", "second");
  close(number);
  CHECK(read_text(folder / "a.txt") == "first second");
  CHECK_THROWS_AS(write_text("/dev/fd/987", "x"), IoError);
}

TEST_CASE("waiting for a pipe without a reader can be interrupted") {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const std::atomic<bool> stop = true;
  const Interruptible interruptible(stop);
  CHECK_THROWS_AS(write_text(pipe, "x"), Interrupted);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK); // reads nothing
  CHECK_THROWS_AS(write_text(pipe, std::string(200000, 'x')), Interrupted);
  close(reader);
}

} // namespace new_file_test
