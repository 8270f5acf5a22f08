#include <keeler/core/words.hpp>

#include <doctest/doctest.h>

using namespace keeler;

TEST_CASE("numbers have no exponent where people write none") {
  CHECK(figures(0.0, 3) == "0");
  CHECK(figures(48.63, 3) == "48.6");
  CHECK(figures(999.6, 3) == "1000");
  CHECK(figures(1234.0, 3) == "1230");
  CHECK(figures(-9999999.0, 7) == "-9999999");
  CHECK(figures(1e7) == "1e7");
  CHECK(figures(1.3e9, 2) == "1.3e9");
  CHECK(figures(2e-8) == "2e-8");
  CHECK(figures(0.00012, 2) == "0.00012");
}

TEST_CASE("counts have their plural") {
  CHECK(counted(1, "thread") == "1 thread");
  CHECK(counted(0, "check") == "0 checks");
  CHECK(counted(34, "particle") == "34 particles");
}
