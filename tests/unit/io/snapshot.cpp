#include <keeler/io/snapshot.hpp>

#include "sealed_file.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/core/units.hpp>
#include <keeler/io/describe.hpp>

#include <doctest/doctest.h>

#include <cstring>
#include <limits>

namespace snapshot_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

namespace {

Patch sample(std::size_t count) {
  Patch patch;
  RandomStream random(1, RandomPurpose::position, 0);
  for (std::size_t k = 0; k < count; ++k) {
    patch.positions.emplace_back(100 * random.normal(), 100 * random.normal(), random.normal());
    patch.velocities.emplace_back(random.normal(), 100 * random.normal(), random.normal());
    patch.radii.push_back(0.5 + random.uniform());
    patch.masses.push_back(1e3 * random.uniform());
    patch.ids.push_back(3 * k + (std::uint64_t{1} << 60));
  }
  patch.box = {245.0, 120.0, 1.5054, 17.25};
  patch.offset = 33.1;
  patch.frequencies = {0.99458, 1.00539};
  patch.orbital_frequency = 1.3175e-4;
  patch.time_orbits = 0.7;
  return patch;
}

const SnapshotMeta meta{"title = \"Ring\"\n[box]\nsize = [245, 120]\n", {{"version", "0"}, {"host", "here"}}};

template<class Row> bool same_bits(const std::vector<Row>& a, const std::vector<Row>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

bool same_but_velocities(const Patch& a, const Patch& b) {
  return same_bits(a.positions, b.positions) && same_bits(a.radii, b.radii) && same_bits(a.masses, b.masses) &&
         a.ids == b.ids && a.box.size_x == b.box.size_x && a.box.size_y == b.box.size_y && a.box.shear == b.box.shear &&
         a.box.first_offset == b.box.first_offset && a.offset == b.offset &&
         a.frequencies.kappa == b.frequencies.kappa && a.frequencies.nu == b.frequencies.nu &&
         a.orbital_frequency == b.orbital_frequency && a.time_orbits == b.time_orbits;
}

// A file opened by plain HDF5, as other programs do.
hdf5::Handle open_plainly(const std::filesystem::path& file, unsigned mode = H5F_ACC_RDONLY) {
  hdf5::Handle opened(H5Fopen(file.c_str(), mode, H5P_DEFAULT), H5Fclose);
  REQUIRE(opened.id() >= 0);
  return opened;
}

haddr_t address(const hdf5::Handle& file, const char* name) {
  H5O_info_t info;
  REQUIRE(H5Oget_info_by_name(file.id(), name, &info, H5P_DEFAULT) >= 0);
  return info.addr;
}

template<class T> std::vector<T> numbers(const hdf5::Handle& file, const char* name) {
  const hdf5::Handle dataset = hdf5::open_dataset(file, name);
  std::vector<T> values(hdf5::layout_of_dataset(dataset).count());
  hdf5::read_dataset(dataset, hdf5::native_type<T>(), values.data());
  return values;
}

} // namespace

TEST_CASE("a snapshot gives back the patch") {
  const TemporaryFolder folder;
  for (const std::size_t count : {0, 1, 2000}) {
    const Patch patch = sample(count);
    write_snapshot(folder / "a.hdf", patch, meta);
    const Snapshot read = read_snapshot(folder / "a.hdf");
    CHECK(same_but_velocities(read.patch, patch));
    CHECK(read.meta.scene == meta.scene);
    CHECK(read.meta.provenance == meta.provenance);
    REQUIRE(read.patch.velocities.size() == count);
    for (std::size_t k = 0; k < count; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        const double v = patch.velocities[k][axis];
        // v Omega and its division by Omega each round by at most eps/2 of the value
        CHECK(std::fabs(read.patch.velocities[k][axis] - v) <= std::numeric_limits<double>::epsilon() * std::fabs(v));
      }
  }
  CHECK(folder.file_count() == 1);
}

TEST_CASE("spins are in a snapshot where there are any, in rad/s") {
  const TemporaryFolder folder;
  Patch patch = sample(50);
  RandomStream random(2, RandomPurpose::velocity, 0);
  for (std::size_t k = 0; k < patch.size(); ++k) {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    patch.spins.emplace_back(x, y, z);
  }
  write_snapshot(folder / "a.hdf", patch, meta);
  const Snapshot read = read_snapshot(folder / "a.hdf");
  REQUIRE(read.patch.spins.size() == patch.size());
  for (std::size_t k = 0; k < patch.size(); ++k)
    CHECK((read.patch.spins[k] - patch.spins[k]).norm() < 1e-15 * patch.spins[k].norm());
  const hdf5::Handle file = open_plainly(folder / "a.hdf");
  CHECK(numbers<double>(file, "PartType1/Spins")[4] == patch.spins[1].y() * 1.3175e-4);
  CHECK(address(file, "VTKHDF/PointData/Spins") == address(file, "PartType1/Spins"));
}

TEST_CASE("a snapshot stores how a clumped state was made") {
  const TemporaryFolder folder;
  SnapshotMeta clumped = meta;
  clumped.clumping = {{"amplitude", {0.1 + 0.2}}, {"history_amplitude", {0.02, 1.0 / 3.0, 0.3}}};
  write_snapshot(folder / "a.hdf", sample(10), clumped);
  CHECK(read_snapshot(folder / "a.hdf").meta.clumping == clumped.clumping);
  const auto attributes = describe_file(folder / "a.hdf").attributes;
  CHECK(attributes.at("Clumping/amplitude") == "0.30000000000000004");
  CHECK(attributes.at("Clumping/history_amplitude") == "[0.02, 0.3333333333333333, 0.3]");

  write_snapshot(folder / "b.hdf", sample(10), meta);
  CHECK(read_snapshot(folder / "b.hdf").meta.clumping.empty());
  CHECK_FALSE(hdf5::exists(open_sealed(folder / "b.hdf"), "Clumping"));
}

TEST_CASE("GADGET readers find their groups, in SI") {
  const TemporaryFolder folder;
  const Patch patch = sample(100);
  write_snapshot(folder / "a.hdf", patch, meta);
  const hdf5::Handle file = open_plainly(folder / "a.hdf");

  const hdf5::Handle header = hdf5::open_group(file, "Header");
  CHECK(hdf5::read_attribute_values<std::uint32_t>(header, "NumPart_ThisFile") ==
        std::vector<std::uint32_t>{0, 100, 0, 0, 0, 0});
  CHECK(hdf5::read_attribute_values<double>(header, "MassTable") == std::vector<double>(6, 0.0));
  CHECK(hdf5::read_attribute<std::int32_t>(header, "NumFilesPerSnapshot") == 1);
  CHECK(hdf5::layout_of_attribute(header, "BoxSize").shape.empty()); // a 3-vector fails in yt
  CHECK(hdf5::read_attribute<double>(header, "BoxSize") == 245.0);
  CHECK(hdf5::read_attribute<double>(header, "Time") == doctest::Approx(0.7 * two_pi / 1.3175e-4).epsilon(1e-15));

  const hdf5::Handle particles = hdf5::open_group(file, "PartType1");
  CHECK(hdf5::names_in(particles) ==
        std::vector<std::string>{"Coordinates", "Masses", "ParticleIDs", "Radius", "Velocities"});
  const hdf5::Handle velocities = hdf5::open_dataset(particles, "Velocities");
  CHECK(hdf5::layout_of_dataset(velocities).shape == hdf5::Shape{100, 3});
  CHECK(hdf5::read_text_attribute(velocities, "unit") == "m/s");
  CHECK(numbers<double>(file, "PartType1/Velocities")[5] == patch.velocities[1].z() * 1.3175e-4);
  CHECK(numbers<double>(file, "PartType1/Coordinates")[5] == patch.positions[1].z());

  CHECK(hdf5::read_text_attribute(hdf5::open_group(file, "Parameters"), "scene") == meta.scene);
  const hdf5::Handle ring = hdf5::open_group(file, "RingBox");
  const auto low = hdf5::read_attribute_values<double>(ring, "bounds_low");
  const auto high = hdf5::read_attribute_values<double>(ring, "bounds_high");
  for (const Vec3& position : patch.positions)
    for (std::size_t axis = 0; axis < 3; ++axis)
      CHECK((low[axis] <= position[static_cast<int>(axis)] && position[static_cast<int>(axis)] <= high[axis]));
  CHECK((low[0] <= -122.5 && high[0] >= 122.5));
  // openPMD's root attributes beside GADGET groups make a file ambiguous to yt
  CHECK(hdf5::attribute_names(file).empty());
}

TEST_CASE("ParaView finds an unstructured grid of vertices that shares the arrays") {
  const TemporaryFolder folder;
  write_snapshot(folder / "a.hdf", sample(100), meta);
  const hdf5::Handle file = open_plainly(folder / "a.hdf");

  const hdf5::Handle grid = hdf5::open_group(file, "VTKHDF");
  CHECK(hdf5::read_attribute_values<std::int64_t>(grid, "Version") == std::vector<std::int64_t>{1, 0});
  CHECK(hdf5::read_text_attribute(grid, "Type") == "UnstructuredGrid");
  const hdf5::Handle type(H5Aopen(grid.id(), "Type", H5P_DEFAULT), H5Aclose);
  const hdf5::Handle text(H5Aget_type(type.id()), H5Tclose);
  CHECK(H5Tis_variable_str(text.id()) == 0); // ParaView reads a text of fixed length only
  CHECK(H5Tget_cset(text.id()) == H5T_CSET_ASCII);
  CHECK(H5Tget_size(text.id()) == std::string("UnstructuredGrid").size());

  for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    CHECK(numbers<std::int64_t>(grid, name) == std::vector<std::int64_t>{100});
  const auto offsets = numbers<std::int64_t>(grid, "Offsets"),
             connectivity = numbers<std::int64_t>(grid, "Connectivity");
  REQUIRE(offsets.size() == 101);
  REQUIRE(connectivity.size() == 100);
  for (std::size_t k = 0; k < 100; ++k)
    CHECK((offsets[k] == static_cast<std::int64_t>(k) && connectivity[k] == static_cast<std::int64_t>(k)));
  CHECK(offsets[100] == 100);
  CHECK(numbers<std::uint8_t>(grid, "Types") == std::vector<std::uint8_t>(100, 1));

  CHECK(address(file, "VTKHDF/Points") == address(file, "PartType1/Coordinates"));
  for (const std::string name : {"Velocities", "Masses", "ParticleIDs", "Radius"})
    CHECK(address(file, ("VTKHDF/PointData/" + name).c_str()) == address(file, ("PartType1/" + name).c_str()));
}

TEST_CASE("damage gives an error or the very same patch") {
  const TemporaryFolder folder;
  const auto file = folder / "a.hdf";
  write_snapshot(file, sample(50), meta);
  const Patch whole = read_snapshot(file).patch;
  for_each_damage(file, 1009, [&](const std::string& damage) {
    CAPTURE(damage);
    try {
      const Patch read = read_snapshot(file).patch;
      CHECK(same_but_velocities(read, whole));
      CHECK(same_bits(read.velocities, whole.velocities));
    } catch (const IoError& error) {
      CHECK(std::string(error.what()).find("a.hdf") != std::string::npos);
    }
  });
}

TEST_CASE("another tool may change a snapshot, within what a patch can be") {
  const TemporaryFolder folder;
  const auto file = folder / "a.hdf";
  const Patch patch = sample(3);
  const auto overwrite = [&](const char* name, hid_t type, const void* data) {
    const hdf5::Handle opened = open_plainly(file, H5F_ACC_RDWR);
    const hdf5::Handle dataset = hdf5::open_dataset(opened, name);
    REQUIRE(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  };
  write_snapshot(file, patch, meta);
  const std::vector<double> radii{7, 8, 9};
  overwrite("PartType1/Radius", H5T_NATIVE_DOUBLE, radii.data());
  CHECK(read_snapshot(file).patch.radii == radii);
  const std::vector<std::uint64_t> ids{1, 3, 3};
  overwrite("PartType1/ParticleIDs", H5T_NATIVE_UINT64, ids.data());
  CHECK_THROWS_WITH_AS(read_snapshot(file), doctest::Contains("ParticleIDs do not increase"), IoError);

  write_snapshot(file, patch, meta);
  {
    const hdf5::Handle opened = open_plainly(file, H5F_ACC_RDWR);
    REQUIRE(H5Ldelete(opened.id(), "PartType1/Masses", H5P_DEFAULT) >= 0);
  }
  CHECK_THROWS_WITH_AS(read_snapshot(file), doctest::Contains("Masses"), IoError);
  {
    const hdf5::Handle opened = open_plainly(file, H5F_ACC_RDWR);
    hdf5::write_dataset(hdf5::open_group(opened, "PartType1"), "Masses", std::vector<double>{1, 2});
  }
  CHECK_THROWS_WITH_AS(read_snapshot(file), doctest::Contains("Masses has the shape [2], not [3]"), IoError);

  SealedFile(file).finish();
  CHECK_THROWS_WITH_AS(read_snapshot(file), doctest::Contains("not a Keeler snapshot"), IoError);
}

TEST_CASE("a snapshot written in pieces equals that of the whole patch, byte by byte") {
  const TemporaryFolder folder;
  const Patch patch = sample(SnapshotFile::piece + 4321);
  write_snapshot(folder / "whole.hdf", patch, meta);
  const auto rows = [&](const auto& all, std::size_t first, std::size_t count) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return std::remove_cvref_t<decltype(all)>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  SnapshotFile pieces(folder / "pieces.hdf", patch, patch.size(), false, meta);
  for (std::size_t first = 0; first < patch.size(); first += SnapshotFile::piece) {
    const std::size_t count = std::min(SnapshotFile::piece, patch.size() - first);
    Patch piece = patch;
    piece.positions = rows(patch.positions, first, count);
    piece.velocities = rows(patch.velocities, first, count);
    piece.radii = rows(patch.radii, first, count);
    piece.masses = rows(patch.masses, first, count);
    piece.ids = rows(patch.ids, first, count);
    pieces.add(piece);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "pieces.hdf"));
  pieces.finish();
  CHECK(files::read_file(folder / "pieces.hdf") == files::read_file(folder / "whole.hdf"));
  CHECK(same_but_velocities(read_snapshot(folder / "pieces.hdf").patch, patch));
  { const SnapshotFile unfinished(folder / "other.hdf", patch, patch.size(), false, meta); }
  CHECK(folder.file_count() == 2);
}

TEST_CASE("a full disk is an error and leaves the former snapshot") {
  const TemporaryFolder folder;
  const auto file = folder / "a.hdf";
  write_snapshot(file, sample(10), meta);
  {
    const SmallDisk disk(5000);
    CHECK_THROWS_AS(write_snapshot(file, sample(2000), meta), IoError);
  }
  CHECK(read_snapshot(file).patch.size() == 10);
  CHECK(folder.file_count() == 1);
}

} // namespace snapshot_test
