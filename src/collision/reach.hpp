// How far particles may go in one step. Beyond some boxes a patch that repeats says nothing of a ring any more, and a
// search through so many images would not end.
#pragma once

#include <keeler/core/error.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace keeler {

inline constexpr double max_boxes_a_step = 300.0;

/// Throws InvariantError when what meets within a step may come from farther than that. Both in m.
inline void require_reach(double reach_x, double reach_y, const ShearingBox& box) {
  const double boxes = std::max(reach_x / box.size_x, reach_y / box.size_y);
  if (!(boxes <= max_boxes_a_step))
    throw InvariantError(fmt::format("particles cross the box {:.3g} times in one step (more than {:g} times is beyond "
                                     "what a patch stands for); take a shorter step, a larger box or slower particles",
                                     boxes, max_boxes_a_step));
}

} // namespace keeler
