#include <keeler/io/checkpoint.hpp>

#include "sealed_file.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <cstring>
#include <limits>

namespace checkpoint_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

namespace {

struct Row {
  double a, b, c;
};

// State with fields of every type.
struct Subject {
  std::vector<Row> rows;
  std::vector<float> floats;
  std::vector<std::uint64_t> ids;
  std::vector<std::uint32_t> stamps;
  std::int64_t step = 0;
  double offset = 0.0;

  FieldTable table() {
    FieldTable table;
    table.rows<double>("rows", rows, "m", "three numbers a row");
    table.rows<float>("floats", floats, "1", "single precision");
    table.rows<std::uint64_t>("ids", ids, "1", "identity");
    table.rows<std::uint32_t>("stamps", stamps, "1", "may be empty");
    table.scalar("step", step, "1", "steps done");
    table.scalar("offset", offset, "m", "shear offset");
    return table;
  }

  bool same_bits(const Subject& other) const {
    const auto equal = [](const auto& a, const auto& b) {
      return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
    };
    return equal(rows, other.rows) && equal(floats, other.floats) && equal(ids, other.ids) &&
           equal(stamps, other.stamps) && step == other.step && std::memcmp(&offset, &other.offset, sizeof offset) == 0;
  }
};

Subject sample(std::size_t count) {
  Subject subject;
  RandomStream random(1, RandomPurpose::position, 0);
  for (std::size_t k = 0; k < count; ++k) {
    subject.rows.push_back({random.normal(), 1e-310 * random.uniform(), -0.0});
    subject.floats.push_back(static_cast<float>(random.normal()));
    subject.ids.push_back(~std::uint64_t{k});
  }
  subject.rows.push_back({std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 0.1});
  subject.step = std::numeric_limits<std::int64_t>::min();
  subject.offset = 1.0 / 3.0;
  return subject;
}

CheckpointHeader read_checkpoint(const std::filesystem::path& file, const FieldTable& table) {
  const Checkpoint checkpoint(file);
  checkpoint.read(table);
  return checkpoint.header();
}

const CheckpointHeader header{"title = \"Ring κ\"\n", {{"version", "0"}, {"host", ""}}};

// Writes fields and scene as write_checkpoint() does, with any version and checksum.
void write_by_hand(const std::filesystem::path& file, std::int64_t version, const std::string& checksum) {
  SealedFile out(file);
  out.write([&](const hdf5::Handle& root) {
    hdf5::write_attribute(root, "format", std::string_view("keeler checkpoint"));
    hdf5::write_attribute(root, "format_version", version);
    hdf5::write_attribute(root, "checksum", checksum);
    hdf5::write_text_dataset(root, "scene", "");
    const hdf5::Handle provenance = hdf5::create_group(root, "provenance");
    hdf5::write_attribute(provenance, "version", std::string_view("0.7"));
    hdf5::write_attribute(provenance, "commit", std::string_view("abc"));
    hdf5::create_group(root, "fields");
  });
  out.finish();
}

} // namespace

TEST_CASE("a checkpoint gives back every bit") {
  const TemporaryFolder folder;
  for (const std::size_t count : {0, 1, 1000}) {
    Subject written = sample(count), read;
    read.rows.resize(7); // whatever was there before
    write_checkpoint(folder / "a.h5", written.table(), header);
    const CheckpointHeader found = read_checkpoint(folder / "a.h5", read.table());
    CHECK(read.same_bits(written));
    CHECK(found.scene == header.scene);
    CHECK(found.provenance == header.provenance);
    CHECK(Checkpoint(folder / "a.h5").header().scene == header.scene);
  }
  CHECK(folder.file_count() == 1);
}

TEST_CASE("the checksum covers fields and scene, not provenance or the order of the table") {
  const TemporaryFolder folder;
  const auto checksum = [&](Subject subject, const CheckpointHeader& with) {
    write_checkpoint(folder / "a.h5", subject.table(), with);
    return hdf5::read_text_attribute(open_sealed(folder / "a.h5"), "checksum");
  };
  Subject subject = sample(10);
  const std::string first = checksum(subject, header);
  CHECK(checksum(subject, {header.scene, {{"host", "elsewhere"}}}) == first);
  CHECK(checksum(subject, {"", header.provenance}) != first);
  subject.ids[3] ^= 1;
  CHECK(checksum(subject, header) != first);

  FieldTable forward, backward;
  forward.scalar("a", subject.step, "1", ""), forward.scalar("b", subject.offset, "1", "");
  backward.scalar("b", subject.offset, "1", ""), backward.scalar("a", subject.step, "1", "");
  const auto of_table = [&](const FieldTable& table) {
    write_checkpoint(folder / "a.h5", table, header);
    return hdf5::read_text_attribute(open_sealed(folder / "a.h5"), "checksum");
  };
  CHECK(of_table(forward) == of_table(backward));
}

TEST_CASE("every damage is an error that names the file, and the table keeps what it held") {
  const TemporaryFolder folder;
  const auto file = folder / "a.h5";
  Subject written = sample(100);
  write_checkpoint(file, written.table(), header);
  const Subject before = sample(5);
  for_each_damage(file, 37, [&](const std::string& damage) {
    CAPTURE(damage);
    Subject read = before;
    CHECK_THROWS_WITH_AS(read_checkpoint(file, read.table()), doctest::Contains("a.h5"), IoError);
    CHECK(read.same_bits(before));
  });
  Subject read;
  read_checkpoint(file, read.table());
  CHECK(read.same_bits(written));
}

TEST_CASE("fields that are not those of the table are errors that name the field") {
  const TemporaryFolder folder;
  const auto file = folder / "a.h5";
  double number = 1.0;
  std::int64_t count = 2;
  std::vector<Row> rows{{1, 2, 3}};
  FieldTable written;
  written.scalar("number", number, "1", "");
  written.rows<double>("rows", rows, "1", "");
  write_checkpoint(file, written, header);

  const auto refused = [&](const FieldTable& table, const char* reason) {
    CHECK_THROWS_WITH_AS(read_checkpoint(file, table), doctest::Contains(reason), IoError);
    CHECK(number == 1.0);
    CHECK(rows.size() == 1);
  };
  FieldTable more = written;
  more.scalar("count", count, "1", "");
  refused(more, "no field 'count'");
  FieldTable fewer;
  fewer.scalar("number", number, "1", "");
  refused(fewer, "a field 'rows' that this run does not have");

  FieldTable other_type, other_shape, scalar_now;
  other_type.scalar("number", count, "1", "");
  other_type.rows<double>("rows", rows, "1", "");
  refused(other_type, "field 'number' is float64 there and int64 here");
  std::vector<double> narrow;
  other_shape.scalar("number", number, "1", "");
  other_shape.rows<double>("rows", narrow, "1", "");
  refused(other_shape, "field 'rows'");
  std::vector<double> wide;
  scalar_now.rows<double>("number", wide, "1", "");
  scalar_now.rows<double>("rows", rows, "1", "");
  refused(scalar_now, "field 'number'");
}

TEST_CASE("another version and other contents are refused with the reason") {
  const TemporaryFolder folder;
  const auto file = folder / "a.h5";
  FieldTable none;
  write_checkpoint(file, none, {});
  const std::string right = hdf5::read_text_attribute(open_sealed(file), "checksum");
  write_by_hand(file, 5, right);
  CHECK_NOTHROW(read_checkpoint(file, none));
  write_by_hand(file, 5, std::string(32, '0'));
  CHECK_THROWS_WITH_AS(read_checkpoint(file, none), doctest::Contains("do not match their checksum"), IoError);
  write_by_hand(file, 6, right);
  CHECK_THROWS_WITH_AS(read_checkpoint(file, none),
                       doctest::Contains("use the newer Keeler 0.7 (commit abc), which wrote it"), IoError);
  write_by_hand(file, 1, right);
  CHECK_THROWS_WITH_AS(
      read_checkpoint(file, none),
      doctest::Contains("use the older Keeler 0.7 (commit abc), which wrote it, or begin a run from its newest"),
      IoError);
  SealedFile(file).finish();
  CHECK_THROWS_WITH_AS(read_checkpoint(file, none), doctest::Contains("not a checkpoint"), IoError);
}

TEST_CASE("a full disk is an error and leaves the former checkpoint") {
  const TemporaryFolder folder;
  const auto file = folder / "a.h5";
  Subject former = sample(10), larger = sample(20000);
  write_checkpoint(file, former.table(), header);
  for (const std::size_t room : {0, 4096, 400000}) {
    const SmallDisk disk(room);
    CHECK_THROWS_AS(write_checkpoint(file, larger.table(), header), IoError);
  }
  CHECK_THROWS_AS(write_checkpoint(folder / "absent/a.h5", former.table(), header), IoError);
  CHECK(folder.file_count() == 1);
  Subject read;
  read_checkpoint(file, read.table());
  CHECK(read.same_bits(former));
}

} // namespace checkpoint_test
