// The presets' frequencies, and the lengths that follow from them.
#include "scenes.hpp"

#include <keeler/core/units.hpp>
#include <keeler/scene/load.hpp>
#include <keeler/scene/planet.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace planet_test {

using namespace keeler;
using namespace keeler::scene;
using namespace keeler::test;

namespace {

Scene preset_scene(const std::string& preset) {
  return parse_scene(changed(least, "orbital_frequency = 2e-4", "preset = \"" + preset + "\""), "s.toml");
}

} // namespace

TEST_CASE("the presets' frequencies give their distances") {
  // Distances for which the frequencies were computed. 3e-4: five digits of the frequencies, and J4, which the formula
  // leaves out and which is largest for the C ring.
  const std::vector<std::pair<std::string, double>> places = {
      {"saturn-c-ring", 84.0e6},        {"saturn-b-ring", 100.0e6},
      {"saturn-b-ring-outer", 105.0e6}, {"saturn-cassini-division", 120.0e6},
      {"saturn-a-ring", 130.0e6},       {"saturn-f-ring", 140.221e6}};
  for (const auto& [name, distance] : places) {
    const PlanetSettings planet = preset_scene(name).planet;
    CAPTURE(planet.orbital_frequency);
    CHECK(distance_from_saturn(planet) == doctest::Approx(distance).epsilon(3e-4));
    // an axisymmetric planet without density at the ring: κ² + ν² = 2Ω² (Laplace), to the digits given
    const Frequencies& f = planet.frequencies;
    CHECK(f.kappa * f.kappa + f.nu * f.nu == doctest::Approx(2.0).epsilon(2e-5));
  }
}

// κ² + ν² = 2Ω² is broken only by rounding where J2 alone is taken; the distance follows from the mass,
// a³ = 2GM/(Ω² + κ²) (for J2 alone). Masses: of Haumea Ragozzine & Brown 2009, of Quaoar Morgado et al. 2023.
// Chariklo's must be in the range of Leiva et al. 2017, to 5 %.
TEST_CASE("the presets of small bodies give the masses of the bodies") {
  const auto mass_at = [](const std::string& preset, double distance) {
    const PlanetSettings planet = preset_scene(preset).planet;
    const Frequencies& f = planet.frequencies;
    CHECK(f.kappa * f.kappa + f.nu * f.nu == doctest::Approx(2.0).epsilon(2e-3));
    const double mean = 0.5 * std::pow(planet.orbital_frequency, 2) * (1.0 + f.kappa * f.kappa);
    return mean * std::pow(distance, 3) / newton_g_si;
  };
  CHECK(mass_at("haumea-ring", 2287e3) == doctest::Approx(4.006e21).epsilon(1e-3));
  CHECK(mass_at("quaoar-q1r", 4057e3) == doctest::Approx(1.20e21).epsilon(1e-3));
  const double chariklo = mass_at("chariklo-c1r", 385.9e3);
  CHECK(chariklo > 0.95 * 6e18);
  CHECK(chariklo < 8e18);
}

TEST_CASE("Toomre's Q and wavelength are consistent") {
  // c_x = Q × 3.36 G Σ / κ and λ = 4π²GΣ/κ²: at Q = 1 the ratio c_x / (κ λ) is 3.36 / 4π²
  const PlanetSettings planet = preset_scene("saturn-a-ring").planet;
  const double kappa = planet.orbital_frequency * planet.frequencies.kappa;
  const double speed = 3.36 / (4 * pi * pi) * kappa * critical_wavelength(400, planet);
  CHECK(toomre_q(400, speed, planet) == doctest::Approx(1.0).epsilon(1e-12));
}

} // namespace planet_test
