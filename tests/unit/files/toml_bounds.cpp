#include <keeler/files/toml_bounds.hpp>

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace toml_bounds_test {

using namespace keeler;
using namespace keeler::files;

namespace {

std::string dotted(std::size_t parts) {
  std::string name = "a";
  for (std::size_t k = 1; k < parts; ++k)
    name += ".a";
  return name;
}

std::string nested(std::size_t depth) {
  return std::string(depth, '[') + std::string(depth, ']');
}

} // namespace

TEST_CASE("the depth of names and lists is limited") {
  CHECK_FALSE(toml_excess(dotted(max_toml_depth) + " = 1.5"));
  CHECK(toml_excess(dotted(max_toml_depth + 1) + " = 1.5"));
  CHECK_FALSE(toml_excess("a = " + nested(max_toml_depth)));
  CHECK(toml_excess("a = " + nested(max_toml_depth + 1)));
  CHECK_FALSE(toml_excess("a = [" + nested(3) + "," + nested(3) + "]\nb = 1.0\nc.d = [1.0, 2.0, 3.0]\n"));
  CHECK_THROWS_WITH_AS(require_bounded_toml("é = 1\n[é." + dotted(20) + "]\n", "s.toml"),
                       "s.toml:2:33: a name of more than 16 parts (valid input has only a few); "
                       "shorten it",
                       UsageError);
}

TEST_CASE("strings and comments are read as in TOML") {
  const std::string deep = dotted(40) + nested(40);
  for (const std::string& text :
       std::vector<std::string>{"# " + deep + "\n", "a = \"" + deep + "\"\n", "a = '" + deep + "'\n",
                                "a = \"\\\"" + deep + "\"\n", "a = \"\"\"\n" + deep + "\"\"" + deep + "\"\"\"\"\"\n",
                                "a = '''" + deep + "'" + deep + "'''\n", "a = \"\" # " + deep + "\n"}) {
    CAPTURE(text);
    CHECK_FALSE(toml_excess(text));
    CHECK(toml_excess(text + deep)); // behind it the text is read again
  }
  CHECK(toml_excess("a = '\\' # \n" + deep)); // no escapes there
  CHECK_FALSE(toml_excess("a = \""));
  CHECK_FALSE(toml_excess("\x7f"
                          "ELF\x02" +
                          deep)); // no text
  CHECK_FALSE(toml_excess(""));
  CHECK(toml_excess(std::string(std::size_t{65} << 20, ' ')));
}

} // namespace toml_bounds_test
