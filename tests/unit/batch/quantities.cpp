#include <keeler/batch/quantities.hpp>

#include <keeler/files/files.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <set>

namespace quantities_test {

using namespace keeler;

TEST_CASE("every number of a batch has a name of its own; docs/formats.md has the table") {
  std::set<std::string> names;
  std::string table = "| column | its error | meaning |\n|---|---|---|\n";
  for (const QuantityName& quantity : quantities()) {
    CHECK(names.insert(quantity.column()).second);
    CHECK(names.insert(quantity.error_column()).second);
    table += fmt::format("| `{}` | `{}` | {} |\n", quantity.column(), quantity.error_column(), quantity.meaning);
  }
  const std::string page = read_text(KEELER_SOURCE_DIR "/docs/formats.md");
  INFO("docs/formats.md must hold this table:\n" << table);
  CHECK(page.find(table) != page.npos);
}

} // namespace quantities_test
