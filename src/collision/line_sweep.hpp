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

/// A particle's line; half a line of cache.
struct alignas(32) Line {
  std::int32_t x = 0, y = 0;
  float z = 0.0f, u = 0.0f, v = 0.0f, w = 0.0f, size = 0.0f;
  std::uint32_t place = 0; ///< in the store
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

/// Of so many indices of lines leaves, in their order, those that may touch the given one; returns how many. There must
/// be room for 16 more indices.
using LineSweep = std::size_t (*)(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                                  std::uint32_t* indices, std::size_t count);
inline constexpr std::size_t sweep_padding = 16;

/// Indices of two lines.
struct LinePair {
  std::uint32_t first, second;
};

/// The same for each of the lines [first, last) at once. [begin, end) lies before all of them or begins after the first
/// one; then pairs are of a line with those that come after it. Writes those that may touch; `found` must have room for
/// all, and 16 lines beyond the last must be readable.
using LineGroupSweep = std::size_t (*)(const Line* lines, std::size_t first, std::size_t last, const LineFrame& frame,
                                       const LineSpan& span, std::size_t begin, std::size_t end, LinePair* found);

struct LineSweeps {
  LineSweep one;
  LineGroupSweep group;
};

LineSweeps line_sweeps(InstructionSet set);

} // namespace keeler
