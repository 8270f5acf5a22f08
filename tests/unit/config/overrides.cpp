// Overrides replace what the file says against them.
#include "schema.hpp"

#include <keeler/config/overrides.hpp>
#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

namespace config_overrides_test {

using namespace keeler;
using namespace keeler::config;
using keeler::test::schema;

TEST_CASE("an override replaces a value, an alternative and the keys of another choice") {
  TomlDocument document = parse_document("[gravity]\nopening_angle = 0.5\n[time]\nend = 3\n", "f.toml", schema());
  std::vector<std::string> notices;
  apply_overrides(document, {"time.steps=1e2", "gravity.solver=fft", "title=a word"}, notices);
  CHECK(std::get<std::int64_t>(document.find("time.steps")->value) == 100);
  CHECK(std::get<std::string>(document.find("title")->value) == "a word");
  CHECK(document.find("time.end") == nullptr);
  CHECK(document.find("gravity.opening_angle") == nullptr);
  REQUIRE(notices.size() == 2);
  CHECK(notices[0].find("time.end") == 0);
}

TEST_CASE("an override may use a former name, of a table as well") {
  TomlDocument document = parse_document("time.steps = 3\n", "f.toml", schema());
  std::vector<std::string> notices;
  apply_overrides(document, {"time.kicks=1e2", "moonlet=[{ size = 2 }]", "begin.keep=.5"}, notices);
  CHECK(notices.empty());
  CHECK(std::get<std::int64_t>(document.find("time.steps")->value) == 100);
  CHECK(document.find("moonlet[1].radius"));
  CHECK(std::get<double>(document.find("start.keep")->value) == 0.5);
  CHECK(former_name_notices(document) ==
        std::vector<std::string>{"--set time.kicks=1e2: 'time.kicks' is now called 'time.steps'",
                                 "--set moonlet=[{ size = 2 }]: 'moonlet.size' is now called 'moonlet.radius'",
                                 "--set begin.keep=.5: 'begin.keep' is now called 'start.keep'"});
}

TEST_CASE("a text is taken verbatim, and is overridden") {
  TomlDocument document(schema());
  std::vector<std::string> notices;
  apply_text(document, "title", "1e3", "--title 1e3", notices);
  const DocumentEntry* const title = document.find("title");
  REQUIRE(title);
  CHECK(std::get<std::string>(title->value) == "1e3");
  CHECK(title->overridden);
}

TEST_CASE("texts that are not overrides are refused") {
  TomlDocument document(schema());
  std::vector<std::string> notices;
  for (const char* const bad : {"title", "=1", ".a=1", "a b=1"})
    CHECK_THROWS_AS(apply_overrides(document, {bad}, notices), UsageError);
}

} // namespace config_overrides_test
