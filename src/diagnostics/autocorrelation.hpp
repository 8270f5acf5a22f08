// The 2-D autocorrelation of the surface density of a shearing box,
//
//   ξ(Δx, Δy) = ⟨Σ(x, y) Σ(x + Δx, y + Δy)⟩ / ⟨Σ⟩² − 1,
//
// at real lags, so that snapshots with different shear offsets can be averaged. Particles are deposited on a mesh by
// cloud-in-cell and correlated by Fourier transforms. The box is periodic in y' = y + (d/L_x) x; that shear is applied
// as a phase to the transform along y, column by column, so the mesh stays square and no interpolation is needed.
// The correlation of each particle with itself (shot noise, around zero lag) is subtracted.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cassert>
#include <cstdlib>
#include <span>
#include <vector>

namespace keeler::diagnostics {

/// ξ on a grid of lags: columns Δx = −reach … reach, rows Δy over one period. Symmetric: ξ(−Δ) = ξ(Δ).
struct AutocorrelationMap {
  int reach = 0;                       ///< the last column, 3/4 of the box: beyond the range of all searches
  int rows = 0;                        ///< even
  double spacing_x = 0, spacing_y = 0; ///< m
  std::vector<double> values;          ///< column by column, Δx and Δy rising
  double noise = 0.0;                  ///< standard deviation of a value for random particles

  double half_width() const { return reach * spacing_x; }
  double half_height() const { return 0.5 * rows * spacing_y; }

  /// Returns ξ at column i (−reach … reach) and row j (−rows/2 … rows/2 − 1).
  double value(int i, int j) const {
    assert(std::abs(i) <= reach && j >= -rows / 2 && j < rows / 2);
    return values[static_cast<std::size_t>((i + reach) * rows + j + rows / 2)];
  }

  /// Interpolates bilinearly, periodic in Δy. Precondition: |Δx| ≤ half_width(), else the edge counts.
  double at(double dx, double dy) const;
};

/// Averages ξ over snapshots of one box.
class Autocorrelation {
public:
  /// Precondition: even numbers of columns and rows.
  Autocorrelation(const ShearingBox& box, int columns, int rows);

  /// Adds a snapshot. Throws UsageError if its box has another size.
  void add(const Patch& patch);

  /// Returns the mean over all snapshots. Precondition: at least one was added.
  AutocorrelationMap map() const;

private:
  ShearingBox box_;
  int columns_, rows_;
  AutocorrelationMap sum_;
  double noise_squares_ = 0.0; // Σ over snapshots of the variance of a value
  int count_ = 0;
};

/// Returns ξ averaged over patches (at least one), on a mesh that resolves the larger of λ_cr/32 and the mean distance.
AutocorrelationMap mean_autocorrelation(std::span<const Patch> patches);

} // namespace keeler::diagnostics
