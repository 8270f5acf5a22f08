// Units of the reported numbers, and the systems of units for velocities and viscosities.
#pragma once

#include <string>
#include <string_view>

namespace keeler {

/// A unit: the suffix of names, and the text for display. A pure number has neither.
struct Unit {
  std::string_view suffix; ///< "m2_s"; empty if names do not include it
  std::string_view text;   ///< "m²/s", UTF-8

  friend bool operator==(const Unit&, const Unit&) = default;
};

namespace unit {
inline constexpr Unit none{}, metres{"m", "m"}, metres_per_second{"m_s", "m/s"}, viscosity{"m2_s", "m²/s"},
    specific_energy{"m2_s2", "m²/s²"}, surface_density{"kg_m2", "kg/m²"}, degrees{"degrees", "degrees"},
    orbits{"orbits", "orbits"}, omega{"omega", "Ω"}, seconds{"s", "s"}, megabytes{"mb", "MB"},
    per_radius_speed{"r_omega", "r Ω"}, per_gravity_speed{"g_sigma_omega", "G Σ/Ω"},
    per_radius_viscosity{"r2_omega", "r² Ω"}, per_gravity_viscosity{"g2_sigma2_omega3", "G² Σ²/Ω³"};

/// Returns a unit that is displayed but not part of the name.
inline constexpr Unit unnamed(std::string_view text) {
  return {"", text};
}
} // namespace unit

/// SI; natural units from ⟨r⟩ and Ω; natural units from G, Σ and Ω.
enum class UnitSystem { si, radius, gravity };

/// The natural units of a patch, in SI.
struct PatchUnits {
  double radius = 1.0;    ///< plain mean of the radii, m
  double frequency = 1.0; ///< Ω, rad/s
  double pull = 1.0;      ///< G Σ, m/s²

  double speed(UnitSystem system) const;     ///< 1, r Ω or G Σ/Ω; m/s
  double viscosity(UnitSystem system) const; ///< 1, r² Ω or G² Σ²/Ω³ (Daisaka, Tanaka & Ida 2001); m²/s
};

/// Returns the unit of a system that replaces `si`; only velocities and viscosities have another one.
Unit unit_in(const Unit& si, UnitSystem system);

/// Returns the size of that unit: numbers in `si` are divided by it.
double size_of_unit(const Unit& si, UnitSystem system, const PatchUnits& units);

/// Returns a text without characters that terminals may lack: "G^2 Sigma^2/Omega^3".
std::string ascii(std::string_view text);

} // namespace keeler
