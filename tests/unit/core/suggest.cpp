#include <keeler/core/suggest.hpp>

#include <doctest/doctest.h>

namespace suggest_test {

using namespace keeler;

TEST_CASE("the closest name is suggested for a misspelt word") {
  const std::vector<std::string> names = {"run", "render", "resume", "check"};
  CHECK(closest("rnder", names) == "render");
  CHECK(closest("redner", names) == "render"); // a swap is one edit
  CHECK(closest("chekc", names) == "check");
  CHECK(closest("ran", names) == "run");
  CHECK(closest("run", names) == "run");
}

TEST_CASE("a word that is far from every name has none") {
  CHECK(closest("foo", {"run", "render"}).empty());
  CHECK(closest("", {"run"}).empty());
  CHECK(closest("run", {}).empty());
  CHECK(closest(std::string(101, 'r'), {std::string(100, 'r')}).empty());
}

} // namespace suggest_test
