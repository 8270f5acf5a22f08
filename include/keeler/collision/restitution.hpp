// How much of the normal speed two particles keep when they bounce.
#pragma once

namespace keeler {

/// A law for the coefficient of normal restitution.
struct RestitutionLaw {
  enum class Kind { constant, bridges };
  Kind kind = Kind::constant;
  double value = 0.5; ///< constant: the coefficient, in [0, 1]
  double scale = 0.34; ///< bridges: c in ε = min(1, c (v / 1 cm s⁻¹)^−0.234) (Bridges et al. 1984; 0.32 in other codes)

  /// The coefficient at a normal speed in m/s.
  double coefficient(double speed_si) const;
};

} // namespace keeler
