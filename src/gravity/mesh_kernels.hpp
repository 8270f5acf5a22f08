// Inner loops of the mesh solver in single precision, compiled once for each instruction set: neighbours' attraction,
// the search for neighbours in a range of particles, and the sums over planes. As in kernels.hpp: lanes hold targets or
// wave numbers, sums run in the order of the lists, with + − × alone, so the bits do not depend on the set.
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

/// Up to `capacity` targets in the same units, and what they have gathered. Entries behind the last target are finite.
struct NearTargets {
  static constexpr std::size_t capacity = 16;
  alignas(64) float x[capacity], y[capacity], z[capacity];
  alignas(64) float ax[capacity], ay[capacity], az[capacity];
};

/// A range of particles as they lie in memory, readable to the next multiple of `widest`; masses follow the places.
struct NearRange {
  const double *x, *y, *z;
  const float* mass;
  std::size_t count;
};

/// Where a group is: the places of a range minus the origin, times the scale, are those of NearSources.
struct NearGroup {
  double origin_x, origin_y, origin_z, scale;
  float low[3], high[3]; ///< bounds of the targets in those units
};

/// Two distinct particles closer than this (its square, in cut-off radii) are taken to be one.
inline constexpr float same_near_place_squared = 1e-20f;

struct MeshKernels {
  /// Appends those of a range that are nearer than 1 to the group's bounds. There must be room for all of them.
  void (*gather)(NearSources& sources, const NearRange& range, const NearGroup& group);

  /// Adds Σ m (1/d³ − Σ_j inside_j d^2j) d over sources with 0 < d < 1, six terms. 1/d³ is right to 3e-6.
  void (*attract)(NearTargets& targets, std::size_t target_count, const NearSources& sources, const float* inside);

  /// Sums over planes of 16 numbers each (8 complex ones, a plane every `stride` floats): to the plane k comes
  ///   Σ_{|l − k| ≤ reach} near[|l − k|] from_l + far Σ_{l ≠ k} decay^|l − k| from_l,
  /// all factors 16 at a time. `from` must hold `reach` further planes of zeros before and behind; `spare` holds 16.
  void (*convolve)(const float* from, std::size_t planes, const float* near, std::size_t reach, const float* far,
                   const float* decay, float* to, std::size_t stride);
};

/// The set must be supported.
MeshKernels mesh_kernels(InstructionSet set);

} // namespace keeler
