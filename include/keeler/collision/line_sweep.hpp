// The inner loop of finding neighbours: one straight line against a row of others, in single precision.
//
// Lines are relative to an instant in the middle of a window. Places in the plane are 32-bit fractions of the box, so
// that a difference is that of the nearest image, whatever the size of the box; everything else is in metres. Speeds
// along y are those beyond the local shear. `size` is the radius with all that can bring two spheres closer than their
// lines: curvature, kicks, rounding. A pair is left out only when its lines stay farther apart than the two sizes; all
// instruction sets leave out the same pairs, since they carry out the same operations in single precision.
#pragma once

#include <keeler/core/simd.hpp>

#include <cstddef>
#include <cstdint>

namespace keeler {

struct Line {
  std::int32_t x, y;
  float z, u, v, w, size;
};

/// Lines as arrays, readable for `padding` entries beyond the last.
struct LineArrays {
  static constexpr std::size_t padding = 16;
  const std::int32_t *x, *y;
  const float *z, *u, *v, *w, *size;
};

/// What turns fractions of the box into metres, and the shear: S, and the offset of images across the x edge as a
/// fraction of the box.
struct LineFrame {
  float metres_x, metres_y;
  float shear;
  std::int32_t offset_y;
};

/// From when to when (rad after the lines' instant).
struct LineSpan {
  float begin, end;
};

/// Writes the indices in [begin, end) of lines that may touch the given one; returns how many. `found` must have room
/// for all of them and 16 more.
using LineSweep = std::size_t (*)(const Line& line, const LineArrays& lines, const LineFrame& frame,
                                  const LineSpan& span, std::size_t begin, std::size_t end, std::uint32_t* found);

LineSweep line_sweep(InstructionSet set);

} // namespace keeler
