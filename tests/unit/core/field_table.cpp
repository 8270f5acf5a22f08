#include <keeler/core/field_table.hpp>

#include <doctest/doctest.h>

namespace field_table_test {

using namespace keeler;

TEST_CASE("a table reads and writes the data it is bound to") {
  struct Row {
    double a, b;
  };
  std::vector<Row> rows{{1, 2}, {3, 4}};
  std::int64_t step = 5;
  FieldTable table;
  table.rows<double>("rows", rows, "m", "two numbers a row");
  table.scalar("step", step, "1", "steps done");

  const Field& field = *table.find("rows");
  CHECK(field.components == 2);
  CHECK(field.rows() == 2);
  CHECK(field.bytes() == 32);
  CHECK(static_cast<const double*>(field.data())[3] == 4);
  field.resize(3);
  CHECK(rows.size() == 3);
  *static_cast<std::int64_t*>(table.find("step")->data()) = 6;
  CHECK(step == 6);
  CHECK(table.find("step")->scalar);
  CHECK(table.find("absent") == nullptr);
}

} // namespace field_table_test
