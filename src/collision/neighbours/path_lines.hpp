// Lines tangent to particles' paths, and the bounds on what they leave out.
//
// A path leaves its tangent by at most A t²/2 in a time t, A = 2κ(|e cos φ| + |e sin φ|) + ν²(|i sin ζ| + |i cos ζ|).
#pragma once

#include "kernels.hpp"
#include "search_context.hpp"

namespace keeler::collision {

/// Bound on the rounding of positions in box fractions, m.
inline double position_rounding(const ShearingBox& box) {
  return 4.0 / full_turn * (box.size_x + box.size_y);
}

bool is_finite(const Elements& el);
/// Throws InvariantError if the elements of particle i are not finite.
void require_finite(const Particles& particles, std::size_t i);

/// Returns the line that is tangent to the path at the rotation's time, with its position at the instant `at`. `size`
/// is radius + margin + curvature during `half` (rad) before and after the tangent point.
Line tangent_line(const SearchContext& step, const Body& body, const Rotation& tangent, double margin, double half,
                  const Instant& at);

/// Returns a bound on the rounding of a line in single precision during `half` (rad) before and after its instant, m.
float rounding_of(const Line& line, double half, const ShearingBox& box);

/// Returns the conversions of lines that are taken at that instant.
LineFrame line_frame(const ShearingBox& box, const Instant& at);

/// Returns what LineFollow needs for `half` (rad) before and after `middle`, when reference paths are of the instant
/// `since` (rad) before the middle.
FollowFrame follow_frame(const SearchContext& step, const Rotation& middle, const Instant& at, double since,
                         double half);

/// Offset of a particle's line from its reference path: a vector at the middle of a span, and its rate.
struct PathOffset {
  Vec3 at_middle, rate; ///< m, m/rad
  Vec3 at(double time) const { return at_middle + time * rate; }
};
PathOffset offset_from(const Line& reference, const Line& line, const FollowFrame& follow, const LineFrame& frame);

} // namespace keeler::collision
