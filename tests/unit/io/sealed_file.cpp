#include "sealed_file.hpp"

#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <optional>

namespace sealed_file_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

namespace {

void write_number(const std::filesystem::path& file, double number) {
  SealedFile out(file);
  out.write([&](const hdf5::Handle& root) { hdf5::write_attribute(root, "number", number); });
  out.finish();
}

double number_in(const std::filesystem::path& file, const std::string& name) {
  return read_content(file, [&](const hdf5::Handle& image) { return hdf5::read_attribute<double>(image, name); });
}

} // namespace

TEST_CASE("a sealed file opens here, and in readers that ignore the seal") {
  const TemporaryFolder folder;
  const auto file = folder / "a.h5";
  write_number(file, 42.0);
  CHECK(hdf5::read_attribute<double>(open_sealed(file), "number") == 42.0);
  CHECK(number_in(file, "number") == 42.0);
  const hdf5::Handle plain(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  REQUIRE(plain.id() >= 0);
  CHECK(hdf5::read_attribute<double>(plain, "number") == 42.0);
}

TEST_CASE("a file with an open object cannot be finished") {
  const TemporaryFolder folder;
  {
    SealedFile out(folder / "a.h5");
    std::optional<hdf5::Handle> left;
    out.write([&](const hdf5::Handle& root) { left.emplace(hdf5::create_group(root, "group")); });
    CHECK_THROWS_WITH_AS(out.finish(), doctest::Contains("did not close it"), IoError);
  }
  CHECK(folder.file_count() == 0);
}

TEST_CASE("another tool may change a file in place; it then has no seal") {
  const TemporaryFolder folder;
  const auto file = folder / "a.h5";
  write_number(file, 42.0);
  {
    const hdf5::Handle changed(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    REQUIRE(changed.id() >= 0);
    hdf5::write_attribute(changed, "added", 1.0);
  }
  CHECK(number_in(file, "added") == 1.0);
  CHECK_THROWS_WITH_AS(open_sealed(file), doctest::Contains("a.h5' is damaged"), IoError);
}

TEST_CASE("no damage to a sealed file goes unnoticed") {
  const TemporaryFolder folder;
  const auto file = folder / "a.h5";
  write_number(file, 42.0);
  const std::size_t content = std::filesystem::file_size(file) - 64;
  int damages = 0;
  for_each_damage(file, 1, [&](const std::string& damage) {
    CAPTURE(damage);
    CHECK_THROWS_AS(open_sealed(file), IoError);
    if (++damages % 20 != 0 && damage.find(std::to_string(content)) == std::string::npos)
      return;                                          // a process for each would take minutes under sanitizers
    if (damage == "cut at " + std::to_string(content)) // exactly the seal is gone, the content is whole
      CHECK(number_in(file, "number") == 42.0);
    else
      CHECK_THROWS_AS(number_in(file, "number"), IoError);
  });
}

} // namespace sealed_file_test
