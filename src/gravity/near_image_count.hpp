// The number of images that a pairwise solver sums one by one: the cost of long boxes.
#pragma once

#include <keeler/gravity/solver.hpp>

#include <cstddef>

namespace keeler::gravity {

/// Returns the number of near images, the cell included: with far images 9 for a square box, and about 4.6 per unit of
/// the aspect ratio of a long one.
std::size_t near_image_count(const ShearingBox& box, const ImageSettings& images);

} // namespace keeler::gravity
