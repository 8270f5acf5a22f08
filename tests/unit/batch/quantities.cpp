#include <keeler/batch/quantities.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <set>

namespace quantities_test {

using namespace keeler;
using namespace keeler::batch;

TEST_CASE("every number of a batch has a name of its own; docs/formats.md has the table") {
  std::set<std::string> names;
  std::string table = "| column | its error | meaning |\n|---|---|---|\n";
  const RunQuantities quantities;
  for (const RunColumn& column : quantities.columns()) {
    CHECK(names.insert(column.name).second);
    CHECK(names.insert(column.error_name).second);
    table += fmt::format("| `{}` | `{}` | {} |\n", column.name, column.error_name, column.meaning);
  }
  const std::string page = files::read_text(KEELER_SOURCE_DIR "/docs/formats.md");
  INFO("docs/formats.md must hold this table:\n" << table);
  CHECK(page.find(table) != page.npos);
}

TEST_CASE("others of keeler analyze are columns behind them, a vector three") {
  const std::size_t usual = RunQuantities().columns().size();
  const RunQuantities more({"local_toomre_q", "local_dispersion", "total_viscosity", "clusters.count"});
  REQUIRE(more.columns().size() == usual + 5);
  CHECK(more.columns()[usual].name == "local_toomre_q");
  CHECK(more.columns()[usual + 2].name == "local_dispersion_y_m_s");
  CHECK(more.find("clusters.count") == usual + 4);
  CHECK_FALSE(RunQuantities().find("clusters.count"));
  CHECK_THROWS_WITH_AS(RunQuantities({"toomreq"}), "there is no number 'toomreq' here; did you mean 'toomre_q'?",
                       UsageError);
}

} // namespace quantities_test
