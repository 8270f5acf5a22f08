// The inner loops of the search for neighbours, for the instruction sets that processors have. All leave out the same
// pairs, since they carry out the same operations.
#pragma once

#include "line.hpp"

#include <keeler/core/simd.hpp>

#include <cstddef>

namespace keeler {

inline constexpr std::size_t kernel_padding = 16; ///< lines, indices and pairs behind the last must be readable

/// Of so many indices of lines keeps, in their order, those that may touch the given one in the span; returns how many.
/// `kept` has room for all, and may be `indices`.
using LineSweep = std::size_t (*)(const Line& line, const Line* lines, const LineFrame& frame, const LineSpan& span,
                                  const std::uint32_t* indices, std::size_t count, std::uint32_t* kept);

/// The same for each of the lines [first, last) at once. [begin, end) lies before all of them or begins after the first
/// one; then pairs are of a line with those that come after it. Writes those that may touch; `found` must have room for
/// all.
using LineGroupSweep = std::size_t (*)(const Line* lines, std::size_t first, std::size_t last, const LineFrame& frame,
                                       const LineSpan& span, std::size_t begin, std::size_t end, LinePair* found);

/// Of so many pairs of lines keeps, in their order, those that may touch in the span; returns how many.
using LinePairFilter = std::size_t (*)(const Line* lines, const LineFrame& frame, const LineSpan& span,
                                       const LinePair* pairs, std::size_t count, LinePair* kept);

/// A span of time that lines are made for, as LineFollow needs it.
struct FollowFrame {
  double kappa, nu, shear;
  double after;                      ///< from the epoch of the elements to the middle of the span, rad
  double cos_e, sin_e, cos_i, sin_i; ///< the rotation of epicycles in that time
  double size_x;                     ///< of the box, m
  double per_metre_x, per_metre_y;   ///< fractions of the box
  double offset;                     ///< of the shear in the middle, as a fraction of the box
  double since;                      ///< from the references' instant to the middle, rad
  double half;                       ///< of the span, rad
  double allowance;                  ///< for the rounding of places, m
};

/// For the particles [begin, end), of which `bodies` holds eight doubles each (Body), makes the lines that touch their
/// paths in the middle of the span, and lists those that may leave their reference by more than the slack within it.
/// Returns how many these are. What is not finite leaves. `size` of a reference is radius, slack and curvature.
using LineFollow = std::size_t (*)(const double* bodies, const Line* references, const FollowFrame& frame,
                                   std::size_t begin, std::size_t end, Line* lines, std::uint32_t* leavers);

struct Kernels {
  LineSweep sweep;
  LineGroupSweep sweep_group;
  LinePairFilter filter;
  LineFollow follow;
};

Kernels kernels(InstructionSet set);

} // namespace keeler
