// Straight lines in single precision: the tangents of particles' paths that the neighbour search tests against each
// other.
//
// Positions in the plane are 32-bit fractions of the box, so that a difference is that of the nearest image, whatever
// the size of the box; other lengths are in metres. Speeds along y are relative to the local shear. `size` is the
// radius plus everything by which the path may leave the line: curvature, skin, rounding. No result is computed from a
// line: a pair is rejected only if its lines stay farther apart than the sum of their sizes.
#pragma once

#include <cstdint>

namespace keeler::collision {

/// The side of the box in the units of Line::x and Line::y.
inline constexpr double full_turn = 4294967296.0; // 2³²

/// A position in the box, from its lower corner, and distances in it, in units of 2⁻³² of its sides.
struct BoxPosition {
  std::uint32_t x, y;
};
struct BoxDistance {
  std::uint64_t x, y;
};

/// Half a cache line.
struct alignas(32) Line {
  std::int32_t x = 0, y = 0;
  float z = 0.0f, u = 0.0f, v = 0.0f, w = 0.0f, size = 0.0f;
  /// The index of the particle, in cells; in a pruning interval, 1 if x, y is not the particle's position but another
  /// image of it.
  std::uint32_t tag = 0;
};

inline BoxPosition position_of(const Line& line) {
  constexpr std::uint32_t half = std::uint32_t{1} << 31;
  return {static_cast<std::uint32_t>(line.x) + half, static_cast<std::uint32_t>(line.y) + half};
}

/// Conversion of box fractions to metres, the shear S, and the offset of images across the x edge as a box fraction.
struct LineFrame {
  float metres_x, metres_y;
  float shear;
  std::int32_t offset_y;
};

/// A span of time, rad after the lines' instant.
struct LineSpan {
  float begin, end;
};

/// The indices of two lines.
struct LinePair {
  std::uint32_t first, second;
};

} // namespace keeler::collision
