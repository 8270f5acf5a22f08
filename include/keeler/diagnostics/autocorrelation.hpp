// The 2-D autocorrelation of the surface density of a shearing box,
//
//   ξ(Δx, Δy) = ⟨Σ(x, y) Σ(x + Δx, y + Δy)⟩ / ⟨Σ⟩² − 1,
//
// at real lags, so that snapshots taken at different shear offsets can be averaged. Particles are laid on a mesh by
// cloud-in-cell and correlated by Fourier transforms. The box is periodic in y' = y + (d/L_x) x; that shear is applied
// as a phase to the transform along y, column by column, so the mesh stays square and nothing is interpolated.
// Every particle's correlation with itself (shot noise, around zero lag) is taken out.
#pragma once

#include <keeler/particles/patch.hpp>

#include <span>
#include <vector>

namespace keeler {

/// ξ on a grid of lags: columns Δx = −reach … reach, rows Δy over one period. Symmetric: ξ(−Δ) = ξ(Δ).
struct AutocorrelationMap {
  int reach = 0;                       ///< the last column, 3/4 of the box: farther than any search needs
  int rows = 0;                        ///< even
  double spacing_x = 0, spacing_y = 0; ///< m
  std::vector<double> values;          ///< column by column, Δx and Δy rising
  double noise = 0.0;                  ///< standard deviation of a value if particles stood at random

  double half_width() const { return reach * spacing_x; }
  double half_height() const { return 0.5 * rows * spacing_y; }

  /// ξ at column i (−reach … reach) and row j (−rows/2 … rows/2 − 1).
  double value(int i, int j) const { return values[static_cast<std::size_t>((i + reach) * rows + j + rows / 2)]; }

  /// Bilinear, periodic in Δy, for |Δx| ≤ half_width().
  double at(double dx, double dy) const;
};

/// Averages ξ over snapshots of one box.
class Autocorrelation {
public:
  /// A mesh of columns × rows (even numbers).
  Autocorrelation(const ShearingBox& box, int columns, int rows);

  /// Adds a snapshot. Throws UsageError when its box has another size.
  void add(const Patch& patch);

  /// The mean over all snapshots added, at least one.
  AutocorrelationMap map() const;

private:
  ShearingBox box_;
  int columns_, rows_;
  AutocorrelationMap sum_;
  double noise_squares_ = 0.0; // Σ over snapshots of the variance of a value
  int count_ = 0;
};

/// ξ averaged over patches on a mesh that resolves λ_cr/32 or the mean distance of particles, whichever is coarser.
AutocorrelationMap mean_autocorrelation(std::span<const Patch> patches);

} // namespace keeler
