#include <keeler/collision/settings.hpp>
#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

using namespace keeler;

TEST_CASE("restitution laws") {
  CHECK(constant_restitution(0.4)({.speed = 123.0}) == 0.4);
  const RestitutionLaw bridges = bridges_restitution(0.34);
  CHECK(bridges({.speed = 0.01}) == doctest::Approx(0.34)); // at 1 cm/s, Bridges et al. 1984
  CHECK(bridges({.speed = 0.1}) == doctest::Approx(0.34 * std::pow(10.0, -0.234)));
  CHECK(bridges({.speed = 1e-9}) == 1.0);
  CHECK(bridges({.speed = 0.0}) == 1.0);
}

TEST_CASE("a table of restitution goes through its rows, linear in the logarithm of the speed, constant beyond") {
  const RestitutionLaw law = tabulated_restitution({{0.001, 0.9}, {0.01, 0.5}, {1.0, 0.1}});
  CHECK(law({.speed = 0.0}) == 0.9);
  CHECK(law({.speed = 1e-4}) == 0.9);
  CHECK(law({.speed = 0.001}) == doctest::Approx(0.9));
  CHECK(law({.speed = std::sqrt(1e-5)}) == doctest::Approx(0.7));
  CHECK(law({.speed = 0.01}) == doctest::Approx(0.5));
  CHECK(law({.speed = 0.1}) == doctest::Approx(0.3));
  CHECK(law({.speed = 50.0}) == 0.1);
  // a power law, tabulated finely, is that power law
  NumberRows rows;
  for (double v = 1e-4; v < 1.0; v *= 1.02)
    rows.push_back({v, bridges_restitution(0.34)({.speed = v})});
  const RestitutionLaw fine = tabulated_restitution(rows);
  for (double v = 2e-4; v < 0.9; v *= 1.37)
    CHECK(fine({.speed = v}) == doctest::Approx(bridges_restitution(0.34)({.speed = v})).epsilon(1e-3));
}

TEST_CASE("a faulty table says which row is wrong") {
  const auto fault = [](NumberRows rows) -> std::string {
    try {
      tabulated_restitution(std::move(rows));
    } catch (const UsageError& error) {
      return error.what();
    }
    return {};
  };
  CHECK(fault({}).find("no rows") != std::string::npos);
  CHECK(fault({{0.0, 0.5}}).find("row 1: the speed 0 is not above 0") == 0);
  CHECK(fault({{0.1, 0.5}, {0.1, 0.4}}).find("row 2: the speed 0.1 is not above the one before it") == 0);
  CHECK(fault({{0.1, 0.5}, {0.2, 1.1}}).find("row 2: the coefficient 1.1 is not from 0 to 1") == 0);
  CHECK(fault({{0.1, std::nan("")}}).find("row 1: the coefficient") == 0);
}

TEST_CASE("the rebound asks the law about the impact, and only above the cut") {
  CollisionSettings settings;
  settings.elastic_below = 1e-2;
  Impact seen;
  settings.restitution = [&](const Impact& impact) {
    seen = impact;
    return 0.25;
  };
  const Rebound fast = rebound(settings, 0.5, 1.0, 3.0, 2e-4);
  CHECK(fast.fast);
  CHECK(fast.speed == 0.125);
  CHECK(seen.speed == 0.5 * 2e-4);
  CHECK(seen.radius_low == 1.0);
  CHECK(seen.radius_high == 3.0);
  const Rebound slow = rebound(settings, 0.01, 1.0, 3.0, 2e-4); // the cut is 0.02
  CHECK(!slow.fast);
  CHECK(slow.speed == 0.01);
}
