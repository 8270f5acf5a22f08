// Straight lines in single precision: what the search for neighbours knows of a particle's path.
//
// Places in the plane are 32-bit fractions of the box, so that a difference is that of the nearest image, whatever the
// size of the box; everything else is in metres. Speeds along y are those beyond the local shear. `size` is the radius
// with all by which the path may leave the line: curvature, skin, rounding. Nothing of a result is computed from lines:
// a pair is left out only when its lines stay farther apart than the two sizes.
#pragma once

#include <cstdint>

namespace keeler {

/// A side of the box in those fractions.
inline constexpr double full_turn = 4294967296.0; // 2³²

/// Half a line of cache.
struct alignas(32) Line {
  std::int32_t x = 0, y = 0;
  float z = 0.0f, u = 0.0f, v = 0.0f, w = 0.0f, size = 0.0f;
  std::uint32_t place = 0; ///< in the store; of a step's lines: not 0 when it is of another image than the particle
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

/// Indices of two lines.
struct LinePair {
  std::uint32_t first, second;
};

} // namespace keeler
