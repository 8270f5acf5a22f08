// Streamlines: circles, or epicycles with phases periodic in x, so that the streamlines bunch once per orbit.
//
//   X -> x = X − e cos kX,  y = Y + (2/κ) e sin kX   at time zero; φ = κt + kX later
//   ∂x/∂X = 1 + k e sin(κt + kX): between 1 − q and 1 + q, q = k e < 1, so that streamlines never cross
//
// Several such waves add up, e-vector by e-vector, and streamlines never cross if the sum of their q is below 1. A wave
// is an epicyclic mode of the ring at rest: exact for e -> 0, without pressure, viscosity and gravity.
//
// All particles may oscillate vertically as well, with one inclination and one phase.
#pragma once

#include <keeler/hill/elements.hpp>

#include <vector>

namespace keeler::initial_conditions {

/// Eccentricity vectors e exp(i(kX + phase)) at time zero. Crests travel inward where k > 0, outward where k < 0.
struct EccentricityWave {
  double wave_number = 0.0;  ///< k, rad m⁻¹: ± 2π n / L_x in a periodic box
  double eccentricity = 0.0; ///< e, m
  double phase = 0.0;        ///< rad
};

struct Streamlines {
  std::vector<EccentricityWave> waves;
  double inclination = 0.0; ///< i, m, with i sin ζ = 0 at time zero

  /// Returns n waves per length, bunched by q; the pattern leads outward in phase, or lags if n < 0.
  static Streamlines bunched(int waves, double length, double q);

  /// Add a wave of n crests per length, with Σ/⟨Σ⟩ − 1 = q cos(kx + phase) at time zero, to first order in q: its
  /// amplitude along x is 2 J₁(q) = q − q³/8. Its phase is exact. Precondition: n > 0.
  void add_outward(int n, double length, double q, double phase);
  void add_inward(int n, double length, double q, double phase);
  /// Adds half of either; they interfere with the largest density at time zero.
  void add_standing(int n, double length, double q, double phase);

  /// Returns the elements at time zero on the streamline of guiding centre X, with Y = 0.
  Elements elements(double guiding_x) const;

  /// Returns ∂x/∂X at time zero: the distance of streamlines relative to its mean.
  double spacing(double guiding_x) const;

  /// Returns the X of the streamline at x at time zero.
  double guiding_x(double x) const;
};

} // namespace keeler::initial_conditions
