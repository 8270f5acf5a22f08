// What the words of the key `quality` stand for.
#pragma once

#include <array>
#include <string_view>

namespace keeler {

/// An accuracy by name: what a scene that names it gets where it gives no numbers itself.
struct Quality {
  const char* name;
  double force_error;   ///< of fft and auto: rms error of the force
  double opening_angle; ///< of tree
  double kick_interval; ///< orbits, up to the Hill parameter 0.94, beyond that with its inverse cube
  double physics_error; ///< share of contacts that kicks of this interval make: what the loss exceeds the work by
};

/// The quality of a scene that names none.
inline constexpr const char* default_quality = "balanced";

/// The keys whose numbers a quality gives; a scene that says `quality = "custom"` gets the keys' own defaults.
inline constexpr std::array<std::string_view, 5> keys_of_quality = {
    "time.step", "gravity.solver", "gravity.force_error", "gravity.opening_angle", "gravity.kick_every"};

/// Measured in wakes of the A ring (docs/dev/step.md), the cheapest first.
inline constexpr std::array<Quality, 3> qualities = {
    {{"fast", 1e-2, 0.8, 10e-3, 0.03}, {"balanced", 4e-3, 0.6, 5e-3, 0.01}, {"strict", 1e-3, 0.4, 2e-3, 0.003}}};

} // namespace keeler
