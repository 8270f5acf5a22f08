// How many images of the box a solver by pairs sums one by one: what long boxes cost.
#pragma once

#include <keeler/gravity/images.hpp>

#include <cstddef>

namespace keeler {

/// The cell itself included: with the far images 9 of a square box, and about 4.6 for each time that a long one is as
/// long as wide.
std::size_t near_image_count(const ShearingBox& box, const ImageSettings& images);

} // namespace keeler
