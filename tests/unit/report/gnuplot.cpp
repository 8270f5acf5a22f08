#include <keeler/report/gnuplot.hpp>

#include <doctest/doctest.h>

namespace gnuplot_test {

using namespace keeler;

TEST_CASE("no text of a script for gnuplot is a command") {
  CHECK(gnuplot_string("a 'b' \"c\" `d` @e") == "'a ''b'' \"c\" `d` @e'");
  CHECK(gnuplot_string("a\nsystem \"touch x\"\r#") == "'a?system \"touch x\"?#'");
  CHECK(gnuplot_string(std::string("a\0b\x1b[31m\x7f", 9)) == "'a?b?[31m?'");
  CHECK(gnuplot_string("Ω ′") == "'Ω ′'");
}

} // namespace gnuplot_test
