// Checks, defaults and the resolved text follow from a schema alone.
#include "schema.hpp"

#include <keeler/config/checks.hpp>
#include <keeler/config/settings.hpp>

#include <doctest/doctest.h>

namespace config_settings_test {

using namespace keeler;
using namespace keeler::config;
using keeler::test::schema;

namespace {

std::string refusal(const std::string& text) {
  try {
    check_document(parse_document(text, "f.toml", schema()), "f.toml");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a declaration is found for a path in a list of tables") {
  CHECK(schema().find_key("moonlet[2].radius") == schema().find_key("moonlet.radius"));
  CHECK(schema().find_section("moonlet[2]")->header() == "[[moonlet]]");
  CHECK(schema().find_key("moonlet") == nullptr);
}

TEST_CASE("a document is checked against its schema") {
  CHECK(refusal("time.end = 1\n").empty());
  CHECK(refusal("time.edn = 1\n").find("did you mean \"end\"?") != std::string::npos);
  CHECK(refusal("title = \"a\"\n").find("[time] is missing") != std::string::npos);
  CHECK(refusal("time = { end = 1, steps = 2 }\n").find("time.steps") != std::string::npos);
  CHECK(refusal("time.end = 1\n[[moonlet]]\nradius = -1\n").find("f.toml:3:10: moonlet[1].radius") == 0);
}

TEST_CASE("defaults are in force where their table and condition are, and the resolved text holds them") {
  const Settings settings(
      parse_document("gravity = {}\ntime.steps = 7\nmoonlet = [{ radius = 2 }]\n", "f.toml", schema()));
  CHECK(settings.number("gravity.opening_angle") == 0.6);
  CHECK_FALSE(settings.has("gravity.force_error"));
  CHECK_FALSE(settings.given("gravity.solver"));
  CHECK(settings.given("time.steps"));
  CHECK(settings.resolved() == "title = \"\"\n\n[gravity]\nsolver = \"tree\"\nopening_angle = 0.6\n\n[[moonlet]]\n"
                               "radius = 2.0\n\n[time]\nsteps = 7\n");
  CHECK(settings.motion() == "gravity.solver = \"tree\"\ngravity.opening_angle = 0.6\ntime.kicks = 7\n");
}

TEST_CASE("former names of keys and tables are read as the present ones, and named once each") {
  const TomlDocument document = parse_document(
      "time.kicks = 7e0\n[[moonlet]]\nsize = 2\n[[moonlet]]\nsize = 3\n[begin]\nkeep = 1\n", "f.toml", schema());
  CHECK(std::get<std::int64_t>(document.find("time.steps")->value) == 7);
  CHECK(std::get<std::int64_t>(document.find("moonlet[2].radius")->value) == 3);
  CHECK(std::get<std::int64_t>(document.find("start.keep")->value) == 1);
  CHECK(former_name_notices(document) ==
        std::vector<std::string>{"f.toml:1:6: 'time.kicks' is now called 'time.steps'",
                                 "f.toml:3:1: 'moonlet.size' is now called 'moonlet.radius'",
                                 "f.toml:6:2: 'begin' is now called 'start'"});
  CHECK(schema().find_key("moonlet[1].size") == schema().find_key("moonlet.radius"));
  CHECK(schema().find_key("begin.keep") == schema().find_key("start.keep"));
  CHECK(former_name_notices(parse_document("time.steps = 7\nstart = { keep = 1 }\n", "f.toml", schema())).empty());
}

TEST_CASE("a former name and the present one in one text are refused, whichever is first") {
  const std::string words = "time.kicks cannot be combined with time.steps (its present name); remove one of the two";
  CHECK(refusal("time.kicks = 7\ntime.steps = 7\n") == "f.toml:2:6: " + words);
  CHECK(refusal("time.steps = 7\ntime.kicks = 7\n") == "f.toml:2:6: " + words);
  CHECK(refusal("time.end = 7\n[begin]\nkeep = 1\n[start]\nkeep = 1\n") ==
        "f.toml:4:2: begin cannot be combined with start (its present name); remove one of the two");
}

} // namespace config_settings_test
