// A text keeps what its author wrote when keys of it are changed.
#include "schema.hpp"

#include <keeler/config/edit.hpp>
#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

namespace edit_test {

using namespace keeler;
using keeler::test::schema;

TEST_CASE("values change in place, new keys go below their header, comments are kept") {
  const std::string text = "title = \"Δ ring\" # mine\n[gravity] # of the particles\nsolver = \"tree\" # slow\n"
                           "opening_angle = 0.6\n\n[time]\nend = 3.0\n";
  const std::string edited = edit_document(schema(), text, "s.toml",
                                           {{"gravity.solver", "\"fft\"", "cheaper"},
                                            {"gravity.opening_angle", std::nullopt, ""},
                                            {"gravity.force_error", "2e-3", ""},
                                            {"time.step", "1e-3", "three drifts a kick"}});
  CHECK(edited == "title = \"Δ ring\" # mine\n[gravity] # of the particles\nforce_error = 2e-3\n# cheaper\n"
                  "solver = \"fft\" # slow\n\n[time]\n# three drifts a kick\nstep = 1e-3\nend = 3.0\n");
}

TEST_CASE("tables on one line and dotted keys are edited too") {
  CHECK(edit_document(schema(), "gravity = {} # Δ\n", "s", {{"gravity.kick_every", "5", ""}}) ==
        "gravity = { kick_every = 5 } # Δ\n");
  CHECK(edit_document(schema(), "gravity = { solver = \"tree\", opening_angle = 0.5 }\n", "s",
                      {{"gravity.solver", "\"fft\"", "by tune"}, {"gravity.opening_angle", std::nullopt, ""}}) ==
        "# by tune\ngravity = { solver = \"fft\" }\n");
  CHECK(edit_document(schema(), "gravity = { opening_angle = 0.5, solver = \"tree\" }\n", "s",
                      {{"gravity.opening_angle", std::nullopt, ""}, {"gravity.kick_every", "2", ""}}) ==
        "gravity = { kick_every = 2, solver = \"tree\" }\n");
  CHECK(edit_document(schema(), "time.end = 3.0\ngravity.solver = \"tree\"", "s", {{"time.step", "1e-3", ""}}) ==
        "time.step = 1e-3\ntime.end = 3.0\ngravity.solver = \"tree\"");
  CHECK(edit_document(schema(), "  time.end = 3.0\ntime.step = 1", "s", {{"time.end", std::nullopt, ""}}) ==
        "time.step = 1");
  CHECK(edit_document(schema(), "[time]", "s", {{"time.end", "3", ""}}) == "[time]\nend = 3\n");
}

TEST_CASE("a comment replaces an earlier one of its kind") {
  const std::string once = edit_document(schema(), "[time]\n  step = 1\n", "s", {{"time.step", "2", "tune: cheaper"}});
  CHECK(once == "[time]\n  # tune: cheaper\n  step = 2\n");
  CHECK(edit_document(schema(), once, "s", {{"time.step", "3", "tune: cheapest"}}) ==
        "[time]\n  # tune: cheapest\n  step = 3\n");
  CHECK(edit_document(schema(), "step = 1", "s", {{"step", "3", "mine"}}) == "# mine\nstep = 3");
}

TEST_CASE("keys without a table are inserted at the top, and removed") {
  CHECK(edit_document(schema(), "# a scene\n[time]\nend = 1\n", "s", {{"title", "\"a\"", "named"}}) ==
        "# named\ntitle = \"a\"\n# a scene\n[time]\nend = 1\n");
  CHECK(edit_document(schema(), "quality = \"fast\"\ntitle = \"a\"\n", "s", {{"quality", std::nullopt, ""}}) ==
        "title = \"a\"\n");
  CHECK(edit_document(schema(), "title = \"a\"\n", "s", {{"quality", std::nullopt, ""}}) == "title = \"a\"\n");
}

TEST_CASE("texts that cannot be edited, or are not TOML, are refused") {
  CHECK_THROWS_WITH_AS(edit_document(schema(), "title = \"a\"\n", "s.toml", {{"time.step", "1", ""}}),
                       doctest::Contains("write time.step = 1"), UsageError);
  CHECK_THROWS_WITH_AS(edit_document(schema(), "title = \n", "s.toml", {}), doctest::Contains("s.toml:1"), UsageError);
}

} // namespace edit_test
