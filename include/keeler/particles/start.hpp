// How a calling program places the particles of a scene at the start of a run. Without a start of its own a scene gets
// Keeler's: a uniform layer without overlaps (initial_conditions/initial.hpp).
#pragma once

#include <keeler/core/key.hpp>
#include <keeler/hill/elements.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace keeler::particles {

/// The particles to be placed. Lengths in m, masses in kg, times in rad (one orbit is 2π). Valid only during the call.
struct StartRequest {
  std::span<const double> radii;    ///< one per particle, in the order of the ids from 0
  std::span<const double> masses;   ///< likewise
  ShearingBox box;                  ///< its middle is the origin; its shear offset is zero
  Frequencies frequencies;          ///< κ/Ω, ν/Ω
  double orbital_frequency = 0.0;   ///< Ω, rad/s: 1 m/s is 1/Ω m rad⁻¹
  double velocity_dispersion = 0.0; ///< c_x that the scene asks for, m rad⁻¹
  std::uint64_t seed = 1;           ///< of the scene
};

/// A start that a scene can choose: particles.start = { law = NAME, … }.
struct StartEntry {
  const char* name;      ///< a literal
  std::vector<Key> keys; ///< by their names in the table, which all starts share; they only affect the start
  /// Returns position (m) and velocity (m rad⁻¹, shear included) of each particle, in Hill's frame, in or near the box.
  /// Spheres must not overlap, moonlets of the scene included. The result must depend on the arguments only. In a
  /// distributed run the root alone calls it, for all particles. Throws UsageError if the values do not fit.
  std::function<std::vector<State>(const Parameters& parameters, const StartRequest& request)> place;
};

/// Adds a start of the calling program, in any thread, which scenes can choose from then on, with no patterns of
/// [particles] and no aggregates. Throws UsageError for an invalid entry, a name or a key that is taken.
void add_start(StartEntry entry, IfTaken if_taken = IfTaken::refuse);

/// Returns all starts that were added. The list never changes: what is added later is in another one.
const std::vector<StartEntry>& start_laws();

} // namespace keeler::particles
