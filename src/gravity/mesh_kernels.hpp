// Inner loops of the mesh solver in single precision, compiled once per instruction set: attraction by neighbours, the
// search for neighbours in a range of particles, mass assignment and force interpolation, and sums over planes. As in
// kernels.hpp there is no library code here, and the bits do not depend on the set: all kernels work on sixteen
// numbers, in one register or four, with + − × alone, and sums across them have one order.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>

namespace keeler::gravity {

/// Neighbours of one group, relative to its origin, in cut-off radii.
struct NearSources {
  static constexpr std::size_t capacity = 1024;
  static constexpr std::size_t max_lanes = 16;
  alignas(64) float x[capacity + max_lanes], y[capacity + max_lanes], z[capacity + max_lanes],
      mass[capacity + max_lanes];
  std::size_t count = 0;
};

/// Up to `capacity` targets in units of NearSources, and their accelerations so far.
struct NearTargets {
  static constexpr std::size_t capacity = 32;
  alignas(64) float x[capacity], y[capacity], z[capacity];
  alignas(64) float ax[capacity], ay[capacity], az[capacity];
};

/// Consecutive particles. Precondition: `max_lanes` values behind its end are readable.
struct ParticleRange {
  const double *x, *y, *z;
  const float* mass;
  std::size_t count;
};

/// The frame of a group: positions of a range minus the origin, times the scale, are positions in NearSources.
struct NearGroup {
  double origin_x, origin_y, origin_z; ///< the middle of the targets
  float scale;
  float half[3]; ///< largest distance of targets from the origin along each axis, scaled
};

/// Added to squared distances, in cut-off radii: avoids a division by zero where a target is its own source, and is far
/// below the squared distance of any two bodies.
inline constexpr float min_near_distance_squared = 1e-20f;

/// The values of a mesh (mesh.hpp) from one column on: node I, J, K of x, y, z is
/// values[(I − first_column) column_length + K row_length + J].
struct MeshView {
  float* values;
  std::size_t first_column, column_length, row_length;
  double corner[3];     ///< of cell 0, 0, 0, m
  double per_metre[3];  ///< cells per metre
  std::size_t cells[3]; ///< along each axis; nodes are 3 more
};

/// The self-force of a particle of mass 1 through the mesh: first sin 2πt + second sin 4πt on each axis, where t is the
/// position in the cell (self_force.hpp).
struct SelfForce {
  float first[4], second[4];
};

struct MeshKernels {
  /// Appends the particles of a range that are nearer than 1 to the group's bounds. Precondition: there is capacity for
  /// the whole range.
  void (*gather)(NearSources& sources, const ParticleRange& range, const NearGroup& group);

  /// Adds Σ m (1/d³ − Σ_j inside_j d^2j) d over sources with d < 1, four terms. The error of 1/d³ is below 7e-6. Pads
  /// the list with massless sources to a multiple of `max_lanes`.
  void (*attract)(NearTargets& targets, std::size_t target_count, NearSources& sources, const float* inside);

  /// Adds Σ m (1/d − Σ_j cloud_j d^2j), five terms, to each target's ax, and Σ m x y (1/d³ − Σ_j inside_j d^2j), with
  /// (x, y, z) = d, to its ay: potential and shear stress. Otherwise as attract(); sources at the target's position are
  /// omitted.
  void (*energy)(NearTargets& targets, std::size_t target_count, NearSources& sources, const float* inside,
                 const float* cloud);

  /// Assigns the masses of a range to the mesh, in order.
  void (*spread)(const MeshView& mesh, const ParticleRange& range);

  /// Writes the gradient of the mesh's values at each particle of a range, minus its self-force.
  void (*interpolate)(const MeshView& mesh, const ParticleRange& range, const SelfForce& self, float* x, float* y,
                      float* z);

  /// Sums over planes of 16 numbers each (8 complex ones; planes are `stride` floats apart in `to`). Plane k becomes
  ///   Σ_{|l − k| ≤ reach} near[|l − k|] from_l + far Σ_{l ≠ k} decay^|l − k| from_l,
  /// with 16 values of each factor. Precondition: `from` has reach + 1 further planes of zeros before and behind.
  void (*convolve)(const float* from, std::size_t planes, const float* near, std::size_t reach, const float* far,
                   const float* decay, float* to, std::size_t stride);
};

/// Returns the kernels of a set. Precondition: the processor supports it.
MeshKernels mesh_kernels(InstructionSet set);

} // namespace keeler::gravity
