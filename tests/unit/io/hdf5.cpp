#include "hdf5_content.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include <fcntl.h>

namespace hdf5_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

namespace {

hdf5::Handle new_file(const std::filesystem::path& path) {
  return hdf5::create_on(std::make_shared<hdf5::Disk>(std::make_shared<files::Descriptor>(path, O_RDWR | O_CREAT), 0));
}

} // namespace

TEST_CASE("everything that is written to a file is read back from its bytes") {
  const std::vector<double> values{1.0, -0.0, 1e-310, 0.1};
  const std::string long_text(100000, 'x'); // more than the 64 KiB of older attributes
  const std::vector<std::byte> image = hdf5_content([&](const hdf5::Handle& file) {
    const hdf5::Handle group = hdf5::create_group(file, "group");
    hdf5::write_dataset(group, "plain", values);
    hdf5::write_dataset(group, "packed", values, hdf5::Packing::compressed);
    hdf5::write_dataset(group, "empty", std::vector<std::int64_t>{}, hdf5::Packing::compressed);
    hdf5::write_attribute(group, "number", std::int64_t{-7});
    hdf5::write_attribute(group, "list", std::vector<std::uint32_t>{1, 2, 3});
    hdf5::write_attribute(group, "none", std::string_view(""));
    hdf5::write_attribute(group, "text", long_text);
    hdf5::write_text_dataset(file, "words", "κ = 1\n");
  });
  const hdf5::Handle back = hdf5::open_image(image);
  CHECK(hdf5::used_size(back) == image.size());
  const hdf5::Handle read = hdf5::open_group(back, "group");
  CHECK(hdf5::names_in(read) == std::vector<std::string>{"empty", "packed", "plain"});
  for (const char* name : {"plain", "packed"}) {
    const hdf5::Handle dataset = hdf5::open_dataset(read, name);
    CHECK(hdf5::layout_of_dataset(dataset).type == "float64");
    CHECK(hdf5::layout_of_dataset(dataset).shape == hdf5::Shape{4});
    std::vector<double> found(4);
    hdf5::read_dataset(dataset, hdf5::native_type<double>(), found.data());
    CHECK(std::memcmp(found.data(), values.data(), sizeof(double) * 4) == 0);
  }
  CHECK(hdf5::layout_of_dataset(hdf5::open_dataset(read, "empty")).count() == 0);
  CHECK(hdf5::read_attribute<std::int64_t>(read, "number") == -7);
  CHECK(hdf5::read_attribute_values<std::uint32_t>(read, "list") == std::vector<std::uint32_t>{1, 2, 3});
  CHECK(hdf5::read_text_attribute(read, "none").empty());
  CHECK(hdf5::read_text_attribute(read, "text") == long_text);
  CHECK(hdf5::read_text_dataset(back, "words") == "κ = 1\n");
  CHECK(hdf5::attribute_names(read) == std::vector<std::string>{"list", "none", "number", "text"});
}

TEST_CASE("a group whose names are listed but not found is damaged") {
  std::vector<std::byte> image = hdf5_content([](const hdf5::Handle& file) {
    for (const char* name : {"a", "b", "c"})
      hdf5::create_group(file, name);
  });
  CHECK(hdf5::names_in(hdf5::open_image(image)) == std::vector<std::string>{"a", "b", "c"});
  constexpr std::string_view node = "SNOD"; // HDF5 file format specification, "symbol table node"
  constexpr std::ptrdiff_t header = 8, entry = 40;
  const auto found = std::search(image.begin(), image.end(), node.begin(), node.end(),
                                 [](std::byte byte, char letter) { return std::to_integer<char>(byte) == letter; });
  REQUIRE(found != image.end());
  std::fill_n(found + header + entry, 2 * entry, std::byte{0}); // all but the first name
  CHECK_THROWS_WITH_AS(hdf5::names_in(hdf5::open_image(image)), "cannot list a group: its structures are damaged",
                       IoError);
}

TEST_CASE("equal content gives equal bytes, and files that are open at once do not mix") {
  const auto number = [](double value) {
    return [value](const hdf5::Handle& file) { hdf5::write_attribute(file, "number", value); };
  };
  std::vector<std::byte> inner;
  const std::vector<std::byte> first = hdf5_content([&](const hdf5::Handle& file) {
    inner = hdf5_content(number(2.0));
    number(1.0)(file);
  });
  CHECK(hdf5_content(number(1.0)) == first);
  CHECK(inner != first);
  const hdf5::Handle one_read = hdf5::open_image(first), two_read = hdf5::open_image(inner);
  CHECK(hdf5::read_attribute<double>(one_read, "number") == 1.0);
  CHECK(hdf5::read_attribute<double>(two_read, "number") == 2.0);
}

TEST_CASE("rows that are written piece by piece are those written at once, byte by byte") {
  const std::size_t count = 3 * hdf5::chunk_rows + 17;
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k)
    values[k] = 1.0 / static_cast<double>(k + 1);
  for (const hdf5::Packing packing : {hdf5::Packing::plain, hdf5::Packing::compressed}) {
    const auto whole =
        hdf5_content([&](const hdf5::Handle& file) { hdf5::write_dataset(file, "data", values, packing); });
    for (const std::size_t rows : {hdf5::chunk_rows, 2 * hdf5::chunk_rows})
      CHECK(hdf5_content([&](const hdf5::Handle& file) {
              const auto type = hdf5::native_type<double>();
              const hdf5::Handle dataset = hdf5::create_dataset(file, "data", type, {count}, packing);
              for (std::size_t k = 0; k < count; k += rows)
                hdf5::write_rows(dataset, type, k, std::min(rows, count - k), values.data() + k);
            }) == whole);
    const hdf5::Handle read = hdf5::open_image(whole), dataset = hdf5::open_dataset(read, "data");
    std::vector<double> some(100000);
    hdf5::read_rows(dataset, hdf5::native_type<double>(), 12345, some.size(), some.data());
    CHECK(std::equal(some.begin(), some.end(), values.begin() + 12345));
  }
}

TEST_CASE("a second name is the same object") {
  const TemporaryFolder folder;
  const hdf5::Handle file = new_file(folder / "a.h5");
  const hdf5::Handle a = hdf5::create_group(file, "a"), b = hdf5::create_group(file, "b");
  const hdf5::Handle dataset = hdf5::write_dataset(a, "data", std::vector<double>{1.0, 2.0});
  hdf5::create_hard_link(a, "data", b, "other");
  hdf5::write_attribute(dataset, "unit", std::string_view("m"));
  CHECK(hdf5::read_text_attribute(hdf5::open_dataset(b, "other"), "unit") == "m");
}

TEST_CASE("failures of HDF5 are errors with its reason, and it prints nothing itself") {
  const TemporaryFolder folder;
  const hdf5::Handle file = new_file(folder / "a.h5");
  hdf5::write_dataset(file, "data", std::vector<double>{1.0});
  CHECK_THROWS_WITH_AS(hdf5::open_group(file, "absent"), doctest::Contains("cannot open group 'absent': "), IoError);
  CHECK_THROWS_AS(hdf5::write_dataset(file, "data", std::vector<double>{1.0}), IoError);
  CHECK_THROWS_AS(hdf5::read_attribute<double>(file, "absent"), IoError);
  hdf5::write_attribute(file, "text", std::string_view("no number"));
  CHECK_THROWS_AS(hdf5::read_attribute<double>(file, "text"), IoError);
  hdf5::write_attribute(file, "list", std::vector<double>{1.0, 2.0});
  CHECK_THROWS_AS(hdf5::read_attribute<double>(file, "list"), IoError);
  CHECK_THROWS_AS(hdf5::read_text_attribute(file, "list"), IoError);
  CHECK_THROWS_AS(hdf5::open_image(std::vector<std::byte>(1000)), IoError);
}

} // namespace hdf5_test
