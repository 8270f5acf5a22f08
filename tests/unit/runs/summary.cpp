#include "documented.hpp"
#include "scenes.hpp"
#include "unit/files/disk.hpp"

#include <keeler/runs/summary.hpp>

#include <keeler/core/error.hpp>
#include <keeler/files/files.hpp>
#include <keeler/quantities/views.hpp>
#include <keeler/runs/run.hpp>

#include <doctest/doctest.h>

namespace summary_test {

using namespace keeler;
using namespace keeler::runs;

TEST_CASE("every number of a summary has a name of its own and says what it is; the manual has the table") {
  test::check_documented(summary_quantities(), "docs/manual/commands.md");
}

TEST_CASE("a summary that is read is the one that the run returned") {
  const test::TemporaryFolder work;
  RunOptions options;
  options.folder = work / "run";
  RunRequests requests;
  const RunResult result = start_run(test::small_scene({"time.end=0.1"}), options, requests);
  const nlohmann::ordered_json returned = json_of(result.summary);
  CHECK(returned["provenance"]["version"].is_string());
  CHECK(returned["state_hash"] == result.state_hash);
  CHECK(json_of(read_summary(work / "run")) == returned);
}

TEST_CASE("what is no summary is refused") {
  const test::TemporaryFolder work;
  for (const char* const text : {"{", "[1]", R"({"split": 3})", R"({"wall_s": "long"})"}) {
    files::write_text(work / "summary.json", text);
    CHECK_THROWS_AS(read_summary(work.path()), IoError);
  }
  files::write_text(work / "summary.json", R"({"wall_s": 3.5, "energy_balance": null})"); // of another version
  CHECK(number_in(read_summary(work.path()), "wall") == 3.5);
}

} // namespace summary_test
