#include <keeler/quantities/quantity.hpp>

#include <doctest/doctest.h>

namespace unit_test {

using namespace keeler;
using namespace keeler::quantities;

TEST_CASE("velocities and viscosities have three units, all else has one") {
  const PatchUnits units{2.0, 0.25, 3.0}; // r, Ω, G Σ
  CHECK(size_of_unit(unit::metres_per_second, UnitSystem::si, units) == 1.0);
  CHECK(size_of_unit(unit::metres_per_second, UnitSystem::radius, units) == 0.5);
  CHECK(size_of_unit(unit::metres_per_second, UnitSystem::gravity, units) == 12.0);
  CHECK(size_of_unit(unit::viscosity, UnitSystem::radius, units) == 1.0);
  CHECK(size_of_unit(unit::viscosity, UnitSystem::gravity, units) == 9.0 * 64.0);
  CHECK(size_of_unit(unit::metres, UnitSystem::gravity, units) == 1.0);
  CHECK(unit_in(unit::viscosity, UnitSystem::gravity) == unit::per_gravity_viscosity);
  CHECK(unit_in(unit::metres_per_second, UnitSystem::radius) == unit::per_radius_speed);
  CHECK(unit_in(unit::metres, UnitSystem::radius) == unit::metres);
}

TEST_CASE("terminals get letters") {
  CHECK(ascii("1 ± 2 G² Σ²/Ω³") == "1 +- 2 G^2 Sigma^2/Omega^3");
}

} // namespace unit_test
