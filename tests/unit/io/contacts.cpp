#include <keeler/io/contacts.hpp>

#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

namespace contacts_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

namespace {

std::vector<ContactRow> some_rows() {
  return {{7, 0.0075, Vec3(1.0, -2.0, 1.0 / 3.0), 3, 12, {1, -1}, 2e-4, 1e-3, true},
          {8, 0.0085, Vec3(0.1, 0.2, -0.3), ~std::uint64_t{0} - 1, ~std::uint64_t{0}, {}, 1e-9, 0.0, false}};
}

} // namespace

TEST_CASE("contacts read back as they were written") {
  const TemporaryFolder folder;
  const auto file = folder / "collisions_000000.h5";
  const std::vector<ContactRow> rows = some_rows();
  write_contacts(file, rows, {40, 1.3e-4, "title = \"here\"\n", {{"version", "1"}}});
  const ContactFile read = read_contacts(file);
  CHECK(read.meta.first_row == 40);
  CHECK(read.meta.orbital_frequency == 1.3e-4);
  CHECK(read.meta.scene == "title = \"here\"\n");
  CHECK(read.meta.provenance == Provenance{{"version", "1"}});
  CHECK((read.rows == rows));

  write_contacts(file, {}, {});
  CHECK(read_contacts(file).rows.empty());
}

TEST_CASE("a contact file that is damaged or of another kind is an error") {
  const TemporaryFolder folder;
  const auto file = folder / "collisions_000000.h5";
  write_contacts(file, some_rows(), {});
  const std::string whole = files::read_text(file);
  write_quickly(file, whole.substr(0, whole.size() / 2));
  CHECK_THROWS_WITH_AS(read_contacts(file), doctest::Contains("is damaged"), IoError);
  CHECK_THROWS_AS(read_contacts(folder / "none.h5"), IoError);
}

} // namespace contacts_test
