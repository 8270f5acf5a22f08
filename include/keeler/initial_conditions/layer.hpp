// How the centres of a fresh layer are spread in z: Gaussian, or flat-topped where a Gaussian would be too full in the
// mid-plane. Dense rings are flat-topped too.
#pragma once

namespace keeler {

/// z = slab × u + sigma × n, u uniform in (−1, 1), n normal: ⟨z²⟩ = slab²/3 + sigma².
struct LayerProfile {
  double slab = 0.0;  ///< m
  double sigma = 0.0; ///< m

  /// A Gaussian of this height √⟨z²⟩ (m) whose mid-plane would be filled to `filling`; or, where that is above
  /// `largest`, the profile of the same height with its mid-plane filled to `largest`. A slab, the flattest of all, has
  /// 0.72 of the filling of a Gaussian.
  static LayerProfile of_height(double height, double filling, double largest);

  /// Centres a unit of z in the mid-plane, m^-1, of one centre in all.
  double midplane_density() const;
};

} // namespace keeler
