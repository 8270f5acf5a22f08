#include "hdf5_content.hpp"

#include <keeler/io/particle_table.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <doctest/doctest.h>

#include <functional>

namespace particle_table_test {

using namespace keeler;
using namespace keeler::io;

namespace {

const std::filesystem::path file = std::filesystem::temp_directory_path() / "keeler-test-table";

ParticleTable table_of(const std::string& text) {
  files::write_text(file, text);
  return read_particle_table(file);
}

ParticleTable table_of(const std::function<void(const hdf5::Handle&)>& fill) {
  files::write_file(file, test::hdf5_content(fill));
  return read_particle_table(file);
}

// Returns the message without the path of the file.
template<class Content> std::string fault(const Content& content) {
  try {
    table_of(content);
  } catch (const UsageError& error) {
    const std::string text = error.what();
    CHECK(text.find(file.string()) == 0);
    return text.substr(file.string().size());
  }
  return {};
}

void write_all(const hdf5::Handle& image, const std::vector<std::string>& names) {
  double value = 1.0;
  for (const std::string& name : names) {
    hdf5::write_dataset(image, name, std::vector<double>{value, 10.0 * value});
    value += 1.0;
  }
}

} // namespace

TEST_CASE("columns may have units as suffixes; an id is ignored") {
  const ParticleTable table = table_of("id,x_m,y,z_m,vx_m_s,vy_m_s,vz_m_s,r_m,m_kg,sx_rad_s,sy_rad_s,sz_rad_s\n"
                                       "7,1,2,3,4,5,6,7,8,9,10,11\n");
  REQUIRE(table.size() == 1);
  CHECK(table.positions[0] == Vec3(1, 2, 3));
  CHECK(table.velocities[0] == Vec3(4, 5, 6));
  CHECK(table.radii[0] == 7.0);
  CHECK(table.masses[0] == 8.0);
  CHECK(table.spins[0] == Vec3(9, 10, 11));
  CHECK(fault(std::string("x_kg,y,z,r\n1,2,3,4\n")).find("unknown column 'x_kg'") != std::string::npos);
}

TEST_CASE("the columns of a table may be in any order, in either format") {
  for (const ParticleTable& table : {table_of("m,r,vz,vy,vx,z,y,x\n1,2,3,4,5,6,7,8\n10,20,30,40,50,60,70,80\n"),
                                     table_of([](const hdf5::Handle& image) {
                                       write_all(image, {"m", "r", "vz", "vy", "vx", "z", "y", "x"});
                                     })}) {
    REQUIRE(table.size() == 2);
    CHECK(table.positions[0] == Vec3(8, 7, 6));
    CHECK(table.velocities[1] == Vec3(50, 40, 30));
    CHECK(table.radii == std::vector<double>{2, 20});
    CHECK(table.masses == std::vector<double>{1, 10});
  }
  CHECK(table_of("x y z r\n1 2 3 4\n").velocities.empty());
  CHECK(table_of("x y z r\n1 2 3 4\n").spins.empty());
  for (const ParticleTable& table :
       {table_of("sz r sy z sx y x\n1 2 3 4 5 6 7\n10 20 30 40 50 60 70\n"), table_of([](const hdf5::Handle& image) {
          write_all(image, {"sz", "r", "sy", "z", "sx", "y", "x"});
        })}) {
    CHECK(table.spins == std::vector<Vec3>{Vec3(5, 3, 1), Vec3(50, 30, 10)});
    CHECK(table.velocities.empty());
  }
  CHECK(table_of("x y z r\n1 2 3 4\n").masses.empty());
  CHECK(table_of("x y z r\n\n1 2 3 4\n").location_of(0) == file.string() + ":3");
  CHECK(table_of([](const hdf5::Handle& image) {
          write_all(image, {"r", "x", "y", "z"});
        }).location_of(1) == file.string() + ", row 1");
  std::filesystem::remove(file);
}

TEST_CASE("a table of other columns is refused") {
  const std::string columns = " (the columns are x y z vx vy vz r, m, and sx sy sz)";
  CHECK(fault(std::string("x,y,r\n1,2,3\n")) == ":1: the column 'z' is missing; add it" + columns);
  CHECK(fault(std::string("x,y,z,m\n1,2,3,4\n")) == ":1: the column 'r' is missing; add it" + columns);
  CHECK(fault(std::string("x,y,z,vx,vy,r\n1,2,3,4,5,6\n")) == ":1: the column 'vz' is missing; add it" + columns);
  CHECK(fault(std::string("x,y,z,r,sx,sz\n1,2,3,4,5,6\n")) == ":1: the column 'sy' is missing; add it" + columns);
  CHECK(fault(std::string("name,x,y,z,r\n0,1,2,3,4\n")) == ":1: unknown column 'name'; rename or remove it" + columns);
  CHECK(fault(std::string("x,y,z,r,x\n1,2,3,4,5\n")) == ":1: two columns 'x'; remove one of them" + columns);
  CHECK(fault(std::string("x,y,z,r\n")) == ": the table is empty (a start needs a particle); add a row for each");
  CHECK(fault(std::string("\n# nothing\n")) ==
        ": the table is empty (not even columns are named); begin with a line \"x,y,z,vx,vy,vz,r,m\"");

  using Image = const hdf5::Handle&;
  const auto arrays = [&](const std::function<void(Image)>& fill) { return fault(fill); };
  CHECK(arrays([](Image image) {
          write_all(image, {"x", "y", "z"});
        }) == ": the column 'r' is missing; add it" + columns);
  CHECK(arrays([](Image image) {
          write_all(image, {"x", "y", "z", "r"});
          hdf5::create_group(image, "more");
        }) == ": unknown column 'more'; rename or remove it" + columns);
  CHECK(arrays([](Image image) {
          write_all(image, {"r", "x", "y"});
          hdf5::write_dataset(image, "z", std::vector<double>(3));
        }) == ": z has 3 values, r has 2 (one per particle); make them equally long");
  CHECK(arrays([](Image image) {
          write_all(image, {"r", "x", "y"});
          hdf5::write_text_dataset(image, "z", "up");
        }) == ": z is not a one-dimensional array of numbers; write it as one");
  CHECK(arrays([](Image image) {
          hdf5::create_group(image, "PartType1");
        }).find(": it has groups PartTypeN and no /Header with BoxSize and units; add it, or write x, y, z") == 0);
  CHECK(arrays([](Image image) {
          for (const char* group : {"PartType1", "Code", "RingBox"})
            hdf5::create_group(image, group);
        }) == ": it is a snapshot, not a table; start from it by start.from or --from");
  std::filesystem::remove(file);
}

} // namespace particle_table_test
