// The surface density of a patch on a mesh, and its waves. The box is periodic only in y' = y + (d/L_x) x; that shear
// is applied as a phase between the transforms along y and x, so no interpolation is needed.
#pragma once

#include "mesh_transform.hpp"

#include <keeler/particles/patch.hpp>

namespace keeler::diagnostics {

/// Even numbers of columns (x) and rows (y).
struct MeshSize {
  int columns, rows;
};

/// Returns a mesh that resolves the larger of λ_cr/32 and the mean distance of particles.
MeshSize mesh_size(const Patch& patch);

/// The correlation of particles with themselves, summed: at lags (0, 0), (±1, 0), (0, ±1) and (±1, ±1) of the mesh,
/// with Σ/⟨Σ⟩ as density and the mean over nodes.
struct SelfPairs {
  double centre = 0, along_x = 0, along_y = 0, diagonal = 0;

  double at(int i, int j) const {
    if (i < -1 || i > 1 || j < -1 || j > 1)
      return 0.0;
    return i == 0 ? (j == 0 ? centre : along_y) : (j == 0 ? along_x : diagonal);
  }

  /// Returns its transform at a wave with these phase differences (rad) from node to node. Divided by the number of
  /// nodes, it is the contribution of self-pairs to the power of that wave.
  double wave(double turn_x, double turn_y) const;
};

/// Deposits Σ/⟨Σ⟩ on the mesh by cloud-in-cell and transforms it. Column i, wave j holds the sum over nodes of
/// Σ/⟨Σ⟩ exp(−i k·r), with k_y = 2πj/L_y and k_x = (2πi + k_y d)/L_x plus any multiple of 2π columns/L_x.
SelfPairs density_waves(const Patch& patch, MeshTransform& mesh);

/// Returns Σm²/(Σm)²: the power of a wave of random particles; 1/N for equal masses.
double shot_power(const Patch& patch);

} // namespace keeler::diagnostics
