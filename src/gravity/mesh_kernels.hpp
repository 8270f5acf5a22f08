// Inner loops of the mesh solver in single precision, compiled once for each instruction set: neighbours' attraction,
// the search for neighbours in a range of particles, what passes between particles and mesh, and the sums over planes.
// As in kernels.hpp there is no library code here, and the bits do not depend on the set: everything is written for
// sixteen numbers side by side, be it in one register or four, with + − × alone, and sums across them have one order.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>

namespace keeler {

/// Neighbours of one group, relative to its origin, in cut-off radii.
struct NearSources {
  static constexpr std::size_t capacity = 1024;
  static constexpr std::size_t widest = 16;
  alignas(64) float x[capacity + widest], y[capacity + widest], z[capacity + widest], mass[capacity + widest];
  std::size_t count = 0;
};

/// Up to `capacity` targets in the same units, and what they have gathered.
struct NearTargets {
  static constexpr std::size_t capacity = 32;
  alignas(64) float x[capacity], y[capacity], z[capacity];
  alignas(64) float ax[capacity], ay[capacity], az[capacity];
};

/// A range of particles as they lie in memory, readable to `widest` numbers behind its end.
struct ParticleRange {
  const double *x, *y, *z;
  const float* mass;
  std::size_t count;
};

/// Where a group is: the places of a range minus the origin, times the scale, are those of NearSources.
struct NearGroup {
  double origin_x, origin_y, origin_z; ///< the middle of the targets
  float scale;
  float half[3]; ///< how far the targets reach from there, in those units
};

/// Added to squares of distances, in cut-off radii: what keeps a particle's own place from dividing by zero, and far
/// below the square of any distance of two bodies.
inline constexpr float same_near_place_squared = 1e-20f;

/// The mesh's numbers (mesh.hpp), from one column on: node I, J, K of x, y, z is
/// values[(I − first_column) column_length + K row_length + J].
struct MeshNumbers {
  float* values;
  std::size_t first_column, column_length, row_length;
  double corner[3];     ///< of the cell 0, 0, 0
  double per_metre[3];  ///< cells a metre
  std::size_t cells[3]; ///< of particles; nodes are 3 more
};

/// The force of a particle of mass 1 on itself through the mesh: first sin 2πt + second sin 4πt on each axis, t the
/// place in the cell (self_force.hpp).
struct SelfForce {
  float first[4], second[4];
};

struct MeshKernels {
  /// Appends those of a range that are nearer than 1 to the group's bounds. There must be room for all of them.
  void (*gather)(NearSources& sources, const ParticleRange& range, const NearGroup& group);

  /// Adds Σ m (1/d³ − Σ_j inside_j d^2j) d over sources with d < 1, four terms. 1/d³ is right to 7e-6. Fills up the
  /// list with nothing to a multiple of `widest`.
  void (*attract)(NearTargets& targets, std::size_t target_count, NearSources& sources, const float* inside);

  /// Adds Σ m (1/d − Σ_j cloud_j d^2j), five terms, to each target's ax, and Σ m x y (1/d³ − Σ_j inside_j d^2j), with
  /// (x, y, z) = d, to its ay: potential and shear stress. Else as attract(); the target's own place does not count.
  void (*energy)(NearTargets& targets, std::size_t target_count, NearSources& sources, const float* inside,
                 const float* cloud);

  /// Adds a range of particles to the mesh, one after the other.
  void (*spread)(const MeshNumbers& mesh, const ParticleRange& range);

  /// Gradient of the mesh's values at each particle of a range, without what the particle itself adds to it.
  void (*pull)(const MeshNumbers& mesh, const ParticleRange& range, const SelfForce& self, float* x, float* y,
               float* z);

  /// Sums over planes of 16 numbers each (8 complex ones, a plane every `stride` floats): to the plane k comes
  ///   Σ_{|l − k| ≤ reach} near[|l − k|] from_l + far Σ_{l ≠ k} decay^|l − k| from_l,
  /// all factors 16 at a time. `from` must hold reach + 1 further planes of zeros before and behind.
  void (*convolve)(const float* from, std::size_t planes, const float* near, std::size_t reach, const float* far,
                   const float* decay, float* to, std::size_t stride);
};

/// The set must be supported.
MeshKernels mesh_kernels(InstructionSet set);

} // namespace keeler
