#include <keeler/io/describe.hpp>

#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/io/checkpoint.hpp>
#include <keeler/io/snapshot.hpp>

#include <doctest/doctest.h>

namespace describe_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

TEST_CASE("a checkpoint is described field by field") {
  const TemporaryFolder folder;
  std::int64_t step = -12;
  double offset = 0.1;
  std::vector<std::uint64_t> ids{1, 2, 3};
  FieldTable table;
  table.scalar("step", step, "1", "steps done");
  table.scalar("offset", offset, "m", "shear offset");
  table.rows<std::uint64_t>("ids", ids, "1", "identity");
  write_checkpoint(folder / "a.h5", table, {"title = \"A\"\n", {{"version", "1.2.3"}}});

  const FileDescription description = describe_file(folder / "a.h5");
  CHECK(description.kind == FileKind::checkpoint);
  CHECK(description.format_version == 5);
  CHECK(description.scene == "title = \"A\"\n");
  CHECK(description.attributes.at("provenance/version") == "1.2.3");
  REQUIRE(description.fields.size() == 3);
  CHECK(description.fields[0].name == "ids");
  CHECK(description.fields[0].type == "uint64");
  CHECK(description.fields[0].shape == std::vector<std::uint64_t>{3});
  CHECK(description.fields[1].value == "0.1");
  CHECK(description.fields[1].unit == "m");
  CHECK(description.fields[2].value == "-12");
  CHECK(description.fields[2].about == "steps done");
}

TEST_CASE("a snapshot is described by its arrays and attributes") {
  const TemporaryFolder folder;
  Patch patch;
  patch.positions = patch.velocities = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  patch.radii = patch.masses = {1, 2};
  patch.ids = {0, 1};
  patch.box = {10, 20, 1.5, 0};
  patch.orbital_frequency = 1e-4;
  write_snapshot(folder / "a.hdf", patch, {"title = \"A\"\n", {{"version", "1.2.3"}}});

  const FileDescription description = describe_file(folder / "a.hdf");
  CHECK(description.kind == FileKind::snapshot);
  CHECK(description.attributes.at("RingBox/L_x") == "10");
  CHECK(description.attributes.at("Header/NumPart_Total") == "[0, 2, 0, 0, 0, 0]");
  CHECK(description.attributes.at("Code/version") == "1.2.3");
  CHECK(description.scene == "title = \"A\"\n");
  REQUIRE(description.fields.size() == 5);
  CHECK(description.fields[0].name == "Coordinates");
  CHECK(description.fields[0].shape == std::vector<std::uint64_t>{2, 3});
  CHECK(description.fields[4].name == "Velocities");
  CHECK(description.fields[4].unit == "m/s");
}

TEST_CASE("other files are errors") {
  const TemporaryFolder folder;
  files::write_text(folder / "a.txt", "title = \"A\"\n");
  CHECK_THROWS_WITH_AS(describe_file(folder / "a.txt"), doctest::Contains("a.txt"), IoError);
  CHECK_THROWS_AS(describe_file(folder / "absent"), IoError);
  CHECK_THROWS_AS(describe_file(folder.path()), IoError);
}

} // namespace describe_test
