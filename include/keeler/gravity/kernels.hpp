// The inner loops of gravity: a block of targets attracted by a list of sources, G = 1.
//
// Lanes are targets: each target adds its sources one by one in the order of the list, with + − × / and sqrt alone, so
// the bits do not depend on the width of the registers. One source text is compiled once for each instruction set, with
// raw pointers and no library code (an inline function that both a wide and a portable file emit could be kept by the
// linker in its wide form, and then be met by a processor that lacks it).
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>

namespace keeler {

/// A particle, or an image of one.
struct PointSource {
  double x, y, z;
  double mass;
};

/// A cell of particles: total mass at the centre of mass, and the traceless quadrupole Q = Σ m (3 d dᵀ − d² 1).
struct CellSource {
  double x, y, z;
  double mass;
  double xx, yy, zz, xy, xz, yz;
};

/// Up to `capacity` targets and what they have gathered so far. Entries behind the last target must be finite up to
/// the next multiple of `widest`.
struct TargetBlock {
  static constexpr std::size_t capacity = 64;
  static constexpr std::size_t widest = 8;
  alignas(64) double x[capacity], y[capacity], z[capacity];
  alignas(64) double ax[capacity], ay[capacity], az[capacity];
};

/// A source closer than this (m² in squares) is the target itself and does not attract it. The bound is far below any
/// distance of two bodies and just above where the cube of the distance leaves the range of doubles.
inline constexpr double same_place_squared = 1e-180;

struct AttractionKernels {
  /// Adds Σ m d / |d|³ over point sources.
  void (*points)(TargetBlock& targets, std::size_t target_count, const PointSource* sources, std::size_t count);

  /// Adds Σ m d / |d|³ − Q d / |d|⁵ + (5/2) (d·Q d) d / |d|⁷ over cells, d from target to cell
  /// (e.g. Hernquist 1987, ApJS 64, 715).
  void (*cells)(TargetBlock& targets, std::size_t target_count, const CellSource* sources, std::size_t count);
};

/// The set must be supported.
AttractionKernels attraction_kernels(InstructionSet set);

} // namespace keeler
