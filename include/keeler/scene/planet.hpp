// The planet's frequencies at the box, and what follows from them and from the particles' material. SI units.
#pragma once

#include <keeler/hill/elements.hpp>

#include <string>

namespace keeler::scene {

/// The orbit around the planet, by its frequencies.
struct PlanetSettings {
  std::string preset;             ///< empty if the scene gives the frequencies
  double orbital_frequency = 0.0; ///< rad/s
  Frequencies frequencies;        ///< κ/Ω, ν/Ω
};

/// Returns λ_cr, m (hill/toomre.hpp).
double critical_wavelength(double surface_density, const PlanetSettings& planet);

/// Returns Toomre's Q for a radial velocity dispersion in m/s (hill/toomre.hpp).
double toomre_q(double surface_density, double dispersion, const PlanetSettings& planet);

/// Returns the distance from Saturn's centre (m) at which orbits have these frequencies. Oblateness raises Ω² by as
/// much as it lowers κ², so a³ = 2GM/(Ω² + κ²) holds up to J4; with κ = Ω it is Kepler's law.
double distance_from_saturn(const PlanetSettings& planet);

/// Returns r_h = 0.82 (ρ / 900 kg m⁻³)^{1/3} (a / 10⁸ m): mutual Hill radius over radius sum of two equal particles
/// (Daisaka, Tanaka & Ida 2001). Aggregates form above about 1.1.
double hill_parameter(double density, double distance);

} // namespace keeler::scene
