// Which periodic images attract one by one: rings of boxes around the cell. What lies farther out: mean_sheet.hpp.
//
// With a shear offset a whole column of boxes slides along y. The images of a column are numbered so that its middle
// box is the one nearest to y = 0: the set of boxes then depends on the offset modulo L_y only, holds (−s) with every
// shift s, and reaches equally far to both sides on the average over a shear period.
#pragma once

#include <keeler/box/shearing_box.hpp>
#include <keeler/core/vector.hpp>

#include <vector>

namespace keeler {

/// The shear offset folded into [−L_y/2, L_y/2], exactly.
double folded_offset(const ShearingBox& box, double offset);

/// Shifts (m) of all boxes of that many rings, (2 rings + 1)² of them, the cell's own zero shift included, in a fixed
/// order. The offset must be folded.
std::vector<Vec3> image_shifts(const ShearingBox& box, double offset, int rings);

/// The image of a position that lies in the cell. The offset must be folded.
Vec3 into_cell(const ShearingBox& box, double offset, const Vec3& position);

} // namespace keeler
