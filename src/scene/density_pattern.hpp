// Non-uniform surface density of a fresh patch: a step in x, and a wave that may be inclined to the orbit like
// self-gravity wakes.
#pragma once

namespace keeler {

/// Density of the guiding centres of a fresh patch at zero shear offset: the product of the step and of the wave.
struct DensityPattern {
  double size_x = 1.0, size_y = 1.0; ///< of the box, m

  double low = 0.0, high = 0.0; ///< m: between these x the density is `factor` times that outside
  double factor = 1.0;

  double contrast = 0.0; ///< A of 1 + A cos(k·r)
  int waves_x = 0;       ///< number of waves in the box: k = 2π (waves_x / L_x, waves_y / L_y)
  int waves_y = 0;

  bool uniform() const { return factor == 1.0 && contrast == 0.0; }

  /// Returns Σ/⟨Σ⟩ at a position; its mean over the box is 1.
  double relative(double x, double y) const;

  /// Returns the maximum of relative().
  double peak() const;

  /// Returns 2π/|k| of the wave (m), and the angle of its crests to the orbit (degrees, above 0 if they trail).
  /// Precondition: there is a wave.
  double wavelength() const;
  double pitch() const;

private:
  double mean() const;
};

} // namespace keeler
