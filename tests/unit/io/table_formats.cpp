// Tables of particles in every format: what is written reads back, to the bit where the format keeps bits.
#include "hdf5_content.hpp"

#include <keeler/io/particle_table.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace table_formats_test {

using namespace keeler;
using namespace keeler::io;
using test::TemporaryFolder;

namespace {

// Numbers whose digits a short text would lose; places are inside the box of 60 m x 40 m.
ParticleTable example(std::size_t count, bool full) {
  ParticleTable table;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = static_cast<double>(k);
    table.positions.emplace_back(20.0 * std::sin(t + 0.1), 19.0 * std::cos(3.0 * t), 1e-3 * std::sin(5.0 * t));
    table.radii.push_back(1.0 / (t + 3.0));
    if (full) {
      table.velocities.emplace_back(1e-3 * std::sin(t), -2e-3 * table.positions.back().x(), 1e-9 / (t + 7.0));
      table.masses.push_back(1e4 / (t + 3.0));
      table.spins.emplace_back(1e-4 * std::cos(t), 1e-5, 1.3e-4 / (t + 1.0));
    }
    table.ids.push_back(7 * k + (std::uint64_t{1} << 60));
  }
  table.frame = {60.0, 40.0, 12.3, 1.3e-4, 0.75};
  return table;
}

ParticleTable through(const TableFormat& format, const ParticleTable& table) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / (std::string("table") + format.ending);
  format.write(file, table);
  return read_particle_table(file);
}

void check_close(const std::vector<Vec3>& found, const std::vector<Vec3>& wanted, double digits) {
  REQUIRE(found.size() == wanted.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    CHECK((found[k] - wanted[k]).norm() <= digits);
}

std::string fault_of(std::string_view content, const char* name = "table") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / name;
  files::write_text(file, content);
  try {
    read_particle_table(file);
  } catch (const UsageError& error) {
    const std::string text = error.what();
    CHECK(text.find('\n') == std::string::npos);
    return text.substr(file.string().size());
  }
  return "none";
}

bool has(const std::string& text, const std::string& words) {
  CAPTURE(text);
  return text.find(words) != std::string::npos;
}

std::string gadget_fault(const std::function<void(const hdf5::Handle&)>& fill) {
  const std::vector<std::byte> content = test::hdf5_content(fill);
  return fault_of({reinterpret_cast<const char*>(content.data()), content.size()});
}

void write_vectors(const hdf5::Handle& group, const char* name, const std::vector<double>& values) {
  hdf5::write_dataset(group, name, hdf5::native_type<double>(), {values.size() / 3, 3}, values.data());
}

} // namespace

TEST_CASE("a table reads back from every format that is read") {
  for (const bool full : {true, false})
    for (const std::size_t count : {1U, 2U, 301U}) {
      const ParticleTable table = example(count, full);
      for (const TableFormat& format : table_formats()) {
        CAPTURE(format.name);
        if (std::string_view(format.name) == "vtp")
          continue; // written only: tests/cli/convert.py reads it by VTK
        const ParticleTable again = through(format, table);
        // Places of GADGET are shifted by half of the box, 30 m, and back: a rounding of 60 m.
        const bool shifted = std::string_view(format.name) == "gadget";
        check_close(again.positions, table.positions, shifted ? 60.0 * 2.3e-16 : 0.0);
        check_close(again.velocities, table.velocities, 0.0);
        check_close(again.spins, table.spins, 0.0);
        CHECK(again.radii == table.radii);
        CHECK(again.masses == table.masses);
        if (std::string_view(format.name) == "csv") {
          CHECK(!again.frame.has_box());
          continue;
        }
        CHECK(again.frame.size_x == 60.0);
        CHECK(again.frame.size_y == 40.0);
        CHECK(again.frame.shear_offset == doctest::Approx(12.3).epsilon(1e-15));
        CHECK(again.frame.orbital_frequency == 1.3e-4);
      }
    }
}

TEST_CASE("a table without a box is written without one") {
  ParticleTable table = example(3, true);
  table.frame = {};
  table.ids.clear();
  table.file = "mine.csv";
  for (const TableFormat& format : table_formats()) {
    CAPTURE(format.name);
    if (std::string_view(format.name) == "vtp")
      continue;
    if (std::string_view(format.name) == "gadget") {
      CHECK_THROWS_WITH_AS(through(format, table),
                           doctest::Contains("'mine.csv' states no box, and GADGET's format needs its size"),
                           UsageError);
      continue;
    }
    const ParticleTable again = through(format, table);
    CHECK(!again.frame.has_box());
    check_close(again.positions, table.positions, 0.0);
  }
}

TEST_CASE("extended XYZ of other programs") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "ovito.xyz";
  // Without Origin the cell begins at 0; texts are left out; the offset is the shift of the first vector.
  files::write_text(file,
                    "2\r\n"
                    "comment=\"a b\" lattice=\"60 -12 0 0 40 0 0 0 10\" Properties=species:S:1:pos:R:3:radius:R:1\r\n"
                    "Si 30 14 5 1\r\n"
                    "X  31.5 15 4 2\r\n");
  const ParticleTable table = read_particle_table(file);
  check_close(table.positions, {Vec3(0.0, 0.0, 0.0), Vec3(1.5, 1.0, -1.0)}, 0.0);
  CHECK(table.radii == std::vector<double>{1.0, 2.0});
  CHECK(table.frame.shear_offset == 12.0);
  CHECK(table.location_of(1) == file.string() + ":4");
  files::write_text(
      file, "1\nLattice=\"60 28 0 0 40 0 0 0 10\" Origin=\"-30 -34 -5\" Properties=pos:R:3:radius:R:1\n0 0 0 1\n");
  CHECK(read_particle_table(file).frame.shear_offset == 12.0);
  check_close(read_particle_table(file).positions, {Vec3(0.0, 0.0, 0.0)}, 0.0);

  const std::string head = "1\nProperties=pos:R:3:radius:R:1", row = "\n1 2 3 4\n";
  CHECK(fault_of(head + row) == "none");
  CHECK(has(fault_of(head + ":charge:R:1\n1 2 3 4 5\n"), ":2: unknown property 'charge'"));
  CHECK(has(fault_of("1\nProperties=pos:R:2\n1 2\n"), ":2: the property pos has 2 columns, not 3"));
  CHECK(has(fault_of("1\nProperties=pos:R\n1 2\n"), ":2: Properties are not NAME:TYPE:COUNT"));
  CHECK(has(fault_of("1\nProperties=pos:R:3\n1 2 3\n"), ":2: the column 'r' is missing"));
  CHECK(has(fault_of(head + row + "1 2 3 4\n"), ":4: there are more than 1 rows, or several frames"));
  CHECK(has(fault_of("3\nProperties=pos:R:3:radius:R:1" + row), ":1: 3 rows are announced, and there are 1"));
  CHECK(has(fault_of(head + "\n1 2 3 x\n"), ":3: "));
  CHECK(has(fault_of("0\nProperties=pos:R:3:radius:R:1\n"), "the table is empty"));
  CHECK(has(fault_of("1\nLattice=\"60 0 0 1 40 0 0 0 10\" Properties=pos:R:3:radius:R:1" + row),
            ":2: Lattice is no shearing box"));
  CHECK(has(fault_of("1\nLattice=\"60 0 0 0 40\" Properties=pos:R:3:radius:R:1" + row),
            ":2: Lattice has 5 numbers, not 9"));
  CHECK(has(fault_of("1\nLattice=\"60 0 0 Properties=pos:R:3:radius:R:1" + row),
            ":2: the value of Lattice has no closing quote"));
}

TEST_CASE("faults of npz") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.npz";
  table_format("npz").write(file, example(5, true));
  const std::string good = files::read_text(file);
  CHECK(fault_of(good) == "none");
  for (std::size_t size = 4; size < good.size(); size += 13)
    CHECK(has(fault_of(good.substr(0, size)), ": the archive is damaged or cut short"));
  std::string changed = good;
  changed[good.size() / 4] = static_cast<char>(changed[good.size() / 4] ^ 1);
  CHECK(has(fault_of(changed), ": the archive is damaged or cut short"));
  const auto renamed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
    return fault_of(text);
  };
  CHECK(has(renamed("spins.npy", "wings.npy"), ": unknown array 'wings'; rename or remove it"));
  CHECK(has(renamed("radii.npy", "spins.npy"), ": the array 'positions' has the shape") == false);
  CHECK(has(renamed("positions.npy", "positionx.npy"), ": unknown array 'positionx'"));
}

TEST_CASE("faults of GADGET's format") {
  using Image = const hdf5::Handle&;
  const auto fill = [](Image root, double unit, bool radius, double hubble) {
    const hdf5::Handle header = hdf5::create_group(root, "Header");
    hdf5::write_attribute(header, "BoxSize", 60.0);
    hdf5::write_attribute(header, "HubbleParam", hubble);
    hdf5::write_attribute(header, "MassTable", std::vector<double>{0.0, 0.0, 0.0, 5.0, 0.0, 0.0});
    for (const char* name : {"UnitLength_in_cm", "UnitMass_in_g", "UnitVelocity_in_cm_per_s"})
      if (unit > 0.0)
        hdf5::write_attribute(header, name, unit);
    const hdf5::Handle group = hdf5::create_group(root, "PartType3");
    write_vectors(group, "Coordinates", {30.0, 31.0, 29.0, 0.0, 60.0, 30.0});
    if (radius)
      hdf5::write_dataset(group, "Radius", std::vector<double>{1.0, 2.0});
  };
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "a.hdf5";
  files::write_file(file, test::hdf5_content([&](Image root) { fill(root, 1000.0, true, 1.0); }));
  const ParticleTable table = read_particle_table(file); // lengths in 10 m, masses in kg
  check_close(table.positions, {Vec3(0.0, 10.0, -10.0), Vec3(-300.0, 300.0, 0.0)}, 1e-12);
  CHECK(table.radii == std::vector<double>{10.0, 20.0});
  CHECK(table.masses == std::vector<double>{5.0, 5.0});
  CHECK(table.velocities.empty());
  CHECK(
      has(gadget_fault([&](Image root) { fill(root, 0.0, true, 1.0); }), ": it states no units; add UnitLength_in_cm"));
  CHECK(has(gadget_fault([&](Image root) { fill(root, 100.0, false, 1.0); }), ": /PartType3 has no Radius"));
  CHECK(has(gadget_fault([&](Image root) { fill(root, 100.0, true, 0.7); }),
            ": its HubbleParam is 0.7: a cosmological run"));
  CHECK(has(gadget_fault([&](Image root) {
              fill(root, 100.0, true, 1.0);
              write_vectors(hdf5::create_group(root, "PartType1"), "Coordinates", {1.0, 2.0, 3.0});
            }),
            ": 2 groups PartTypeN have Coordinates"));
  CHECK(has(gadget_fault([&](Image root) {
              fill(root, 100.0, true, 1.0);
              hdf5::write_dataset(hdf5::open_group(root, "PartType3"), "Masses", std::vector<double>(3, 1.0));
            }),
            ": /PartType3/Masses is no array of 2 x 1 numbers"));
  CHECK(has(gadget_fault([&](Image root) { hdf5::create_group(root, "PartType1"); }),
            ": it has groups PartTypeN and no /Header"));
}

TEST_CASE("XML is refused by name") {
  CHECK(has(fault_of("<?xml version=\"1.0\"?>\n<VTKFile>\n"), ": it is XML (VTK's?), which Keeler does not read"));
}

} // namespace table_formats_test
