// The inner loops of gravity: a block of targets attracted by a list of sources, G = 1.
//
// Lanes are targets: each target adds its sources one by one in the order of the list, so the bits do not depend on the
// width of the registers. (Only `far_cells` has sources in its lanes, sixteen in every set.) All use + − × and integer
// operations alone; the reciprocal root starts from the integer trick, not from an instruction that approximates it,
// since those differ between processors. One source text is compiled once for each instruction set, with raw pointers
// and no library code (an inline function that both a wide and a portable file emit could be kept by the linker in its
// wide form, and then be met by a processor that lacks it).
//
// Single precision: forces of single pairs are good to 4e-7, at any distance and anywhere, because places are kept as
// sums of two floats and differences are taken part by part. Masses must be given in units that keep them below 1e4,
// or the weight of an encounter at `same_place` overflows.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>
#include <cstdint>

namespace keeler {

/// A particle, or an image of one.
struct PointSource {
  double x, y, z;
  double mass;
};

/// The same in single precision: the place is (x, y, z) + (x_low, y_low, z_low).
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

/// A run of consecutive points.
struct PointRange {
  std::uint32_t begin, count;
};

/// Up to `capacity` targets and what they have gathered so far. Entries behind the last target must be finite up to
/// the next multiple of `widest`.
struct TargetBlock {
  static constexpr std::size_t capacity = 128;
  static constexpr std::size_t widest = 8;
  alignas(64) double x[capacity], y[capacity], z[capacity];
  alignas(64) double ax[capacity], ay[capacity], az[capacity];
};

/// The same for kernels in single precision. They sum in floats over some 128 sources and add these sums in doubles.
struct SingleTargetBlock {
  static constexpr std::size_t capacity = TargetBlock::capacity;
  static constexpr std::size_t widest = 16;
  alignas(64) float x[capacity], y[capacity], z[capacity];                ///< place, for points
  alignas(64) float x_low[capacity], y_low[capacity], z_low[capacity];    ///< what rounding left of it
  alignas(64) float from_x[capacity], from_y[capacity], from_z[capacity]; ///< relative to the origin, for cells
  alignas(64) double ax[capacity], ay[capacity], az[capacity];
};

/// Cells that act through a local expansion, relative to its centre; what lies behind the last one, up to the next
/// multiple of sixteen, must have no moments and a place other than the centre.
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

/// Two bodies are never this close (m); pairs that are attract as if they were. At distance zero, where a target meets
/// itself, that is no attraction at all.
inline constexpr double same_place = 1e-60;
inline constexpr float same_place_single = 1e-10F;

struct AttractionKernels {
  /// Adds Σ m d / |d|³ over point sources.
  void (*points)(TargetBlock& targets, std::size_t target_count, const PointSource* sources, std::size_t count);

  /// The same in single precision, over runs of sources.
  void (*points_single)(SingleTargetBlock& targets, std::size_t target_count, const SinglePoint* sources,
                        const PointRange* ranges, std::size_t range_count);

  /// Adds Σ m d / |d|³ − Q d / |d|⁵ + (5/2) (d·Q d) d / |d|⁷ over cells, d from target to cell
  /// (e.g. Hernquist 1987, ApJS 64, 715).
  void (*cells)(SingleTargetBlock& targets, std::size_t target_count, const CellSource* sources, std::size_t count);

  /// Adds what cells contribute to a local expansion, before traces are removed: local_expansion.hpp.
  void (*far_cells)(LocalTerms& sums, const FarCells& cells, std::size_t count);

  /// Adds the field of a local expansion, whose tensors are complete with their factors.
  void (*local)(SingleTargetBlock& targets, std::size_t target_count, const LocalTerms& terms);
};

/// The set must be supported.
AttractionKernels attraction_kernels(InstructionSet set);

} // namespace keeler
