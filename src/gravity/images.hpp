// The periodic images that are summed one by one: rings of boxes around the cell. Images farther out: far_images.hpp.
//
// With a shear offset a whole column of boxes slides along y. The images of a column are numbered so that its middle
// box is the one nearest to y = 0. So the set of boxes depends on the offset modulo L_y only, contains −s with every
// shift s, and reaches equally far to both sides on average over a shear period.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <vector>

namespace keeler::gravity {

/// Returns the shear offset folded into [−L_y/2, L_y/2], exactly.
double folded_offset(const ShearingBox& box, double offset);

/// Returns the shifts (m) of the (2 rings_x + 1) (2 rings_y + 1) boxes around the cell, in a fixed order; the shift 0
/// of the cell is one of them. Precondition: the offset is folded.
std::vector<Vec3> image_shifts(const ShearingBox& box, double offset, int rings_x, int rings_y);

/// Returns the image of a position inside the cell. Precondition: the offset is folded.
Vec3 into_cell(const ShearingBox& box, double offset, const Vec3& position);

} // namespace keeler::gravity
