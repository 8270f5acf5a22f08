// The values of the key `quality`.
#pragma once

#include <array>
#include <string_view>

namespace keeler::scene {

/// A named accuracy: the values that a scene of this quality gets for keys that it does not give.
struct Quality {
  const char* name;
  double force_error;   ///< rms error of the force, for fft and auto
  double opening_angle; ///< for the tree
  double kick_interval; ///< orbits, for r_h up to 0.94; above it decreases as r_h⁻³
  double physics_error; ///< relative error of the loss over the work of the shear, by contacts that kicks make
};

/// The quality of a scene without the key.
inline constexpr const char* default_quality = "balanced";

/// The keys that a quality sets. With `quality = "custom"` a scene gets the defaults of these keys.
inline constexpr std::array<std::string_view, 5> keys_of_quality = {
    "time.step", "gravity.solver", "gravity.force_error", "gravity.opening_angle", "gravity.kick_every"};

/// All qualities, the cheapest first; measured in wakes of the A ring (docs/dev/step.md).
inline constexpr std::array<Quality, 3> qualities = {
    {{"fast", 1e-2, 0.8, 10e-3, 0.03}, {"balanced", 4e-3, 0.6, 5e-3, 0.01}, {"strict", 1e-3, 0.4, 2e-3, 0.003}}};

} // namespace keeler::scene
