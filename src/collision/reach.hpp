// The limit on how far particles move in one step. Beyond it a periodic patch no longer represents a ring, and a search
// through that many images would not end.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace keeler::collision {

inline constexpr double max_boxes_per_step = 300.0;

/// Throws InvariantError if particles that meet within a step may come from more boxes away, or if that is not a
/// number. `reach_x`, `reach_y`: bounds on their distance, m.
inline void require_reach(double reach_x, double reach_y, const ShearingBox& box) {
  assert(box.size_x > 0.0 && box.size_y > 0.0);
  const double boxes = std::max(reach_x / box.size_x, reach_y / box.size_y);
  if (!(boxes <= max_boxes_per_step))
    throw InvariantError(fmt::format("particles cross the box {:.3g} times in one step (a patch cannot represent more "
                                     "than {:g} times); take a shorter step, a larger box or slower particles",
                                     boxes, max_boxes_per_step));
}

} // namespace keeler::collision
