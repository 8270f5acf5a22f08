// The surface density of a fresh patch, where it is not the same everywhere: a step in x, and a wave that may be
// inclined to the orbit as self-gravity wakes are.
#pragma once

namespace keeler {

/// Of the guiding centres of a fresh patch, at a shear offset of zero. Both parts multiply; without either the density
/// is uniform.
struct DensityPattern {
  double size_x = 1.0, size_y = 1.0; ///< of the box, m

  double low = 0.0, high = 0.0; ///< m: between these x the density is `factor` times that beside
  double factor = 1.0;

  double contrast = 0.0; ///< A of 1 + A cos(k·r)
  int waves_x = 0;       ///< in the box: k = 2π (waves_x / L_x, waves_y / L_y)
  int waves_y = 0;

  bool uniform() const { return factor == 1.0 && contrast == 0.0; }

  /// Σ/⟨Σ⟩ at a place; 1 on average over the box.
  double relative(double x, double y) const;

  /// No place has more.
  double peak() const;

  /// Of the wave: 2π/|k|, m, and the angle of its crests to the orbit, degrees, above 0 where they trail.
  double wavelength() const;
  double pitch() const;

private:
  double mean() const;
};

} // namespace keeler
