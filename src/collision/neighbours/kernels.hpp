// The inner loops of the neighbour search for each instruction set. All sets carry out the same operations and so keep
// the same pairs.
#pragma once

#include "line.hpp"

#include <keeler/core/simd.hpp>

#include <cstddef>

namespace keeler::collision {

inline constexpr std::size_t kernel_padding = 16; ///< lines, indices and pairs behind the last one must be readable

/// Filters indices[0, count): keeps, in order, the lines that may touch `line` during `span`. Returns the number kept.
/// Precondition: `kept` has room for `count` indices; it may be `indices`.
using LineSweep = std::size_t (*)(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                                  const std::uint32_t* indices, std::size_t count, std::uint32_t* kept);

/// Tests each of the lines [first, last) against each of [begin, end), writes the pairs that may touch, and returns
/// their number. Precondition: begin > first, or end <= first; `found` has room for all pairs. In the first case a pair
/// (i, j) is tested only if i < j.
using LineGroupSweep = std::size_t (*)(const Line* lines, std::size_t first, std::size_t last, const LineFrame& frame,
                                       const LineSpan& span, std::size_t begin, std::size_t end, LinePair* found);

/// Filters pairs[0, count): keeps, in order, the pairs of lines that may touch during `span`. Returns the number kept.
using LinePairFilter = std::size_t (*)(const Line* lines, const LineFrame& frame, const LineSpan& span,
                                       const LinePair* pairs, std::size_t count, LinePair* kept);

/// What LineFollow needs of the span of time that it makes lines for.
struct FollowFrame {
  double kappa, nu, shear;
  double after;                      ///< from the epoch of the elements to the middle of the span, rad
  double cos_e, sin_e, cos_i, sin_i; ///< rotation of the epicycles in that time
  double size_x;                     ///< of the box, m
  double per_metre_x, per_metre_y;   ///< box fractions
  double offset;                     ///< shear offset in the middle of the span, as a box fraction
  double since;                      ///< from the reference paths' instant to the middle, rad
  double half;                       ///< half the span, rad
  double allowance;                  ///< for the rounding of positions, m
};

/// Makes the lines of the particles [begin, end) that are tangent to their paths in the middle of the span. Writes to
/// `escaped` the particles that may leave their reference path by more than the skin within the span, or have elements
/// that are not finite, and returns their number. `bodies` holds eight doubles per particle (Body); `size` of a
/// reference path is radius + skin + curvature.
using LineFollow = std::size_t (*)(const double* bodies, const Line* references, const FollowFrame& frame,
                                   std::size_t begin, std::size_t end, Line* lines, std::uint32_t* escaped);

struct Kernels {
  LineSweep sweep;
  LineGroupSweep sweep_group;
  LinePairFilter filter;
  LineFollow follow;
};

/// Returns the kernels for an instruction set that this processor supports.
Kernels kernels(InstructionSet set);

} // namespace keeler::collision
