// Inner loops of gravity: a block of targets attracted by a list of sources, G = 1.
//
// Lanes are targets: each target adds its sources one by one in the order of the list, so the bits do not depend on the
// width of the registers. (Only `far_cells` has sources in its lanes, sixteen in every set.) All kernels use + − × and
// integer operations alone. The reciprocal root starts from integer arithmetic, not from an approximate instruction,
// which would differ between processors. The source is compiled once per instruction set, with raw pointers and without
// library code: the linker could keep the wide form of an inline function that two files emit, and a processor without
// these instructions would execute it.
//
// Single precision: the force of a pair is accurate to 4e-7, at any distance and position, because positions are sums
// of two floats and differences are taken part by part. Precondition: masses are below 1e4 in the units chosen, or the
// weight of a pair at min_distance overflows.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>
#include <cstdint>

namespace keeler::gravity {

/// A particle, or an image of one.
struct PointSource {
  double x, y, z;
  double mass;
};

/// A source in single precision, at (x, y, z) + (x_low, y_low, z_low).
struct SinglePoint {
  float x, y, z;
  float x_low, y_low, z_low;
  float mass;
  float unused = 0.0F; // 32 bytes
};

/// A cell of particles: total mass at the centre of mass, relative to the block's origin, and the traceless quadrupole
/// Q = Σ m (3 d dᵀ − d² 1).
struct CellSource {
  float x, y, z;
  float mass;
  float xx, yy, zz, xy, xz, yz;
};

/// Points [begin, begin + count).
struct PointRange {
  std::uint32_t begin, count;
};

/// Up to `capacity` targets and their accelerations so far. Precondition: entries behind the last target are finite up
/// to the next multiple of `max_lanes`.
struct TargetBlock {
  static constexpr std::size_t capacity = 128;
  static constexpr std::size_t max_lanes = 8;
  alignas(64) double x[capacity], y[capacity], z[capacity];
  alignas(64) double ax[capacity], ay[capacity], az[capacity];
};

/// Targets of kernels in single precision, which sum some 128 sources in floats and add these sums in doubles.
struct SingleTargetBlock {
  static constexpr std::size_t capacity = TargetBlock::capacity;
  static constexpr std::size_t max_lanes = 16;
  alignas(64) float x[capacity], y[capacity], z[capacity];                ///< position, for points
  alignas(64) float x_low[capacity], y_low[capacity], z_low[capacity];    ///< its remainder after rounding
  alignas(64) float from_x[capacity], from_y[capacity], from_z[capacity]; ///< relative to the origin, for cells
  alignas(64) double ax[capacity], ay[capacity], az[capacity];
};

/// Cells that act through a local expansion, relative to its centre. Precondition: entries behind the last one, up to
/// the next multiple of `lanes`, have zero moments and are not at the centre.
struct FarCells {
  static constexpr std::size_t capacity = 256;
  static constexpr std::size_t lanes = 16;
  alignas(64) float x[capacity], y[capacity], z[capacity], mass[capacity];
  alignas(64) float xx[capacity], yy[capacity], zz[capacity], xy[capacity], xz[capacity], yz[capacity];
};

/// Coefficients of a local expansion to third order of the force: the field, and symmetric tensors of rank 2, 3 and 4
/// in the order xx xy xz yy yz zz, xxx xxy … zzz, xxxx … zzzz.
struct LocalTerms {
  float rank1[3], rank2[6], rank3[10], rank4[15];
};

/// Lower bound of the distance (m) in the weight of a pair. At distance zero, where a target is one of its own sources,
/// the attraction vanishes.
inline constexpr double min_distance = 1e-60;
inline constexpr float min_distance_single = 1e-10F;

struct AttractionKernels {
  /// Adds Σ m d / |d|³ over point sources.
  void (*points)(TargetBlock& targets, std::size_t target_count, const PointSource* sources, std::size_t count);

  /// As points(), in single precision over ranges of sources.
  void (*points_single)(SingleTargetBlock& targets, std::size_t target_count, const SinglePoint* sources,
                        const PointRange* ranges, std::size_t range_count);

  /// Adds Σ m d / |d|³ − Q d / |d|⁵ + (5/2) (d·Q d) d / |d|⁷ over cells, d from target to cell
  /// (e.g. Hernquist 1987, ApJS 64, 715).
  void (*cells)(SingleTargetBlock& targets, std::size_t target_count, const CellSource* sources, std::size_t count);

  /// Adds the contributions of cells to a local expansion, before traces are removed (local_expansion.hpp).
  void (*far_cells)(LocalTerms& sums, const FarCells& cells, std::size_t count);

  /// Adds the field of a local expansion. Precondition: its tensors are complete (local_expansion.hpp).
  void (*local)(SingleTargetBlock& targets, std::size_t target_count, const LocalTerms& terms);
};

/// Returns the kernels of a set. Precondition: the processor supports it.
AttractionKernels attraction_kernels(InstructionSet set);

} // namespace keeler::gravity
