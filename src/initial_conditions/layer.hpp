// The vertical profile of a fresh layer: Gaussian, or flat-topped if a Gaussian would be too dense in the mid-plane.
// Dense rings are flat-topped too.
#pragma once

namespace keeler::initial_conditions {

/// z = slab × u + sigma × n, u uniform in (−1, 1), n normal: ⟨z²⟩ = slab²/3 + sigma².
struct LayerProfile {
  double slab = 0.0;  ///< m
  double sigma = 0.0; ///< m

  /// Returns a Gaussian of this height √⟨z²⟩ (m) with the filling factor `filling` in the mid-plane. If that exceeds
  /// `largest`, returns the profile of this height with the filling factor `largest` there; the limit is a
  /// slab, with 0.72 of the filling factor of a Gaussian.
  static LayerProfile of_height(double height, double filling, double largest);

  /// Returns the probability density of z in the mid-plane, m^-1.
  double midplane_density() const;
};

} // namespace keeler::initial_conditions
