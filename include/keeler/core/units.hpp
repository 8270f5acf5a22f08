// Constants and the units inside the code: lengths in metres, masses in kg, time in radians of orbit (Omega = 1).
// Scene files and outputs are SI and orbits; the conversion happens once, at the edge.
#pragma once

#include <numbers>

namespace keeler {

inline constexpr double pi = std::numbers::pi;
inline constexpr double two_pi = 2.0 * std::numbers::pi; ///< one orbit, in internal time

/// Newton's constant, m^3 kg^-1 s^-2 (CODATA 2018).
inline constexpr double newton_g_si = 6.67430e-11;

/// Newton's constant in internal units, m^3 kg^-1 rad^-2, for an orbital frequency in rad/s.
constexpr double newton_g(double orbital_frequency) {
  return newton_g_si / (orbital_frequency * orbital_frequency);
}

} // namespace keeler
