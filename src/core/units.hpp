// Constants and internal units: lengths in metres, masses in kg, time in radians of orbit (Omega = 1).
// Scene files and outputs are in SI and orbits; they are converted once, on input and output.
#pragma once

#include <numbers>

namespace keeler {

inline constexpr double pi = std::numbers::pi;
inline constexpr double two_pi = 2.0 * std::numbers::pi; ///< one orbit, in internal time

/// Newton's constant, m^3 kg^-1 s^-2 (CODATA 2018).
inline constexpr double newton_g_si = 6.67430e-11;

/// Returns Newton's constant in internal units, m^3 kg^-1 rad^-2. Precondition: orbital_frequency (rad/s) is not 0.
constexpr double newton_g(double orbital_frequency) {
  return newton_g_si / (orbital_frequency * orbital_frequency);
}

} // namespace keeler
