#include <keeler/collision/settings.hpp>
#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace restitution_test {

using namespace keeler;
using namespace keeler::collision;

TEST_CASE("restitution laws") {
  CHECK(constant_restitution(0.4)({.speed = 123.0}) == 0.4);
  const RestitutionLaw bridges = bridges_restitution(0.34);
  CHECK(bridges({.speed = 0.01}) == doctest::Approx(0.34)); // at 1 cm/s, Bridges et al. 1984
  CHECK(bridges({.speed = 0.1}) == doctest::Approx(0.34 * std::pow(10.0, -0.234)));
  CHECK(bridges({.speed = 1e-9}) == 1.0);
  CHECK(bridges({.speed = 0.0}) == 1.0);
}

TEST_CASE("the law of Borderies et al. is elastic up to its critical speed and falls as the root of it far above") {
  const RestitutionLaw law = borderies_restitution(0.001);
  CHECK(law({.speed = 0.0}) == 1.0);
  CHECK(law({.speed = 0.001}) == 1.0);
  CHECK(law({.speed = 0.001 * (1.0 + 1e-9)}) == doctest::Approx(1.0).epsilon(1e-8)); // no jump
  const double u = 0.5, expected = -2.0 / 3.0 * u * u + std::sqrt(10.0 / 3.0 * u * u - 5.0 / 9.0 * u * u * u * u);
  CHECK(law({.speed = 0.002}) == doctest::Approx(std::sqrt(expected)));
  CHECK(law({.speed = 1e3}) == doctest::Approx(std::pow(10.0 / 3.0, 0.25) * 1e-3).epsilon(1e-3));
}

TEST_CASE("the law of Hatzes et al.") {
  const RestitutionLaw law = hatzes_restitution();
  CHECK(law({.speed = 0.01}) == doctest::Approx(0.90 * std::exp(-0.22) + 0.01)); // 1 cm/s
  CHECK(law({.speed = 0.05}) == doctest::Approx(0.90 * std::exp(-1.1) + 0.01 * std::pow(5.0, -0.6)));
  CHECK(law({.speed = 0.0}) == 1.0);
  CHECK(law({.speed = 1e-7}) == 1.0); // 0.9 + 0.01 v^-0.6 passes 1 below 0.02 cm/s
}

// Expanded to second order: 1 − x + 3/5 x² (Schwager & Pöschel 1998), x as v^(1/5) and as 1/r.
TEST_CASE("viscoelastic spheres: slow ones lose as v^(1/5), and larger ones less") {
  const RestitutionLaw law = viscoelastic_restitution(0.005, 2.0);
  const auto of = [&](double speed, double a, double b) { return law({speed, a, b}); };
  CHECK(of(0.005, 2.0, 2.0) == doctest::Approx(3.583 / 9.04));
  for (const double x : {1e-3, 1e-2})
    CHECK(of(0.005 * std::pow(x, 5.0), 2.0, 2.0) == doctest::Approx(1.0 - x + 0.6 * x * x).epsilon(2.0 * x * x * x));
  CHECK(of(0.005, 4.0, 4.0) == doctest::Approx(of(0.005 / 32.0, 2.0, 2.0))); // twice the radius: half of x
  CHECK(of(0.005, 1.0, 3.0) == of(0.005, 3.0, 1.0));
  CHECK(of(0.0, 1.0, 1.0) == 1.0);
}

namespace {

// The speed after a contact over that before it, of m_eff d²ξ/dt² = −ρ (ξ^(3/2) + 3/2 A √ξ dξ/dt) from ξ = 0 to ξ = 0
// (Brilliantov et al. 1996), by the classical Runge–Kutta method. `hardness` is 2Y/(3(1 − ν²)).
double integrated_restitution(double speed, double a, double b, double hardness, double dissipation) {
  const double density = 900.0, pi = std::acos(-1.0);
  const double mass_a = 4.0 / 3.0 * pi * density * a * a * a, mass_b = 4.0 / 3.0 * pi * density * b * b * b;
  const double k = hardness * std::sqrt(a * b / (a + b)) * (mass_a + mass_b) / (mass_a * mass_b);
  const auto pull = [&](double depth, double rate) {
    const double root = std::sqrt(std::max(depth, 0.0));
    return -k * root * (std::max(depth, 0.0) + 1.5 * dissipation * rate);
  };
  const double h = 1e-3 * std::pow(speed * speed / k, 0.4) / speed; // a contact lasts 3200 of these
  double depth = 0.0, rate = speed;
  for (;;) {
    const double v1 = rate, a1 = pull(depth, rate), v2 = rate + 0.5 * h * a1, a2 = pull(depth + 0.5 * h * v1, v2),
                 v3 = rate + 0.5 * h * a2, a3 = pull(depth + 0.5 * h * v2, v3), v4 = rate + h * a3,
                 a4 = pull(depth + h * v3, v4);
    depth += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    rate += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    if (depth <= 0.0)
      return -rate / speed;
  }
}

} // namespace

// x = 1.15344 (3/2) A (ρ/m_eff)^(2/5) v^(1/5) of the series (Schwager & Pöschel 1998), so two spheres of 1 m with x = 1
// at the law's speed fix A. Up to x = 0.36 the fraction is the equation's to 1e-3.
TEST_CASE("viscoelastic spheres of different sizes bounce as their equation of motion says") {
  const double hardness = 1e8, speed = 0.005, pi = std::acos(-1.0);
  const double k0 = hardness * std::sqrt(0.5) * 2.0 / (4.0 / 3.0 * pi * 900.0);
  const double dissipation = 1.0 / (1.15344 * 1.5 * std::pow(k0, 0.4) * std::pow(speed, 0.2));
  const RestitutionLaw law = viscoelastic_restitution(speed, 1.0);
  struct Pair {
    double a, b;
  };
  for (const Pair pair : {Pair{1.0, 1.0}, {3.0, 3.0}, {6.0, 1.5}, {40.0, 3.0}, {2.0, 0.8}})
    for (const double v : {1e-6, 1e-5}) {
      const double expected = integrated_restitution(v, pair.a, pair.b, hardness, dissipation);
      CAPTURE(pair.a);
      CAPTURE(pair.b);
      CAPTURE(v);
      CHECK(expected < 0.97);
      CHECK(std::fabs(law({v, pair.a, pair.b}) - expected) < 1e-3);
    }
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

TEST_CASE("a law of one's own is known by its name, and to the program that brought it alone") {
  const RestitutionEntry& own = restitution_laws().back();
  REQUIRE(std::string(own.name) == "own");
  const auto named = [](const std::string& name) {
    Parameters parameters;
    parameters.set("name", name);
    return parameters;
  };
  CHECK_THROWS_WITH_AS(own.make(named("soft-ice")), doctest::Contains("'soft-ice' is a function of the program"),
                       UsageError);
  add_own_restitution("soft-ice", [](const Impact& impact) { return 1.0 / (1.0 + impact.speed / impact.radius_low); });
  CHECK(own.make(named("soft-ice"))({.speed = 2.0, .radius_low = 2.0, .radius_high = 1.0}) == 0.5);
  add_own_restitution("brittle",
                      [](const Impact& impact) { return impact.radius_low > 1.0 ? impact.speed - 2.0 : 0.5; });
  const RestitutionLaw brittle = own.make(named("brittle"));
  CHECK(brittle({.speed = 3.0, .radius_low = 2.0, .radius_high = 1.0}) == 1.0);
  for (const double speed : {3.5, 1.5, HUGE_VAL, std::nan("")})
    CHECK_THROWS_WITH_AS(brittle({.speed = speed, .radius_low = 2.0, .radius_high = 1.0}),
                         doctest::Contains("'brittle' gives"), UsageError);
  CHECK_THROWS_AS(add_own_restitution("soft-ice", constant_restitution(0.5)), UsageError); // taken
  CHECK_THROWS_AS(add_own_restitution("", constant_restitution(0.5)), UsageError);
  CHECK_THROWS_AS(add_own_restitution("bouncy", constant_restitution(1.1)), UsageError);
  CHECK_THROWS_AS(add_own_restitution("nothing", [](const Impact&) { return std::nan(""); }), UsageError);
}

} // namespace restitution_test
