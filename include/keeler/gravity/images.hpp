// Which periodic images attract one by one: rings of boxes around the cell. What lies farther out: far_images.hpp.
//
// With a shear offset a whole column of boxes slides along y. The images of a column are numbered so that its middle
// box is the one nearest to y = 0: the set of boxes then depends on the offset modulo L_y only, holds (−s) with every
// shift s, and reaches equally far to both sides on the average over a shear period.
#pragma once

#include <keeler/core/vector.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <vector>

namespace keeler {

/// The shear offset folded into [−L_y/2, L_y/2], exactly.
double folded_offset(const ShearingBox& box, double offset);

/// Which images attract.
struct ImageSettings {
  int rings = 1;   ///< rings of boxes around the cell that are summed one by one (1 is 9 boxes)
  bool far = true; ///< and all images beyond, so that the force is truly periodic; otherwise exactly these rings act
};

/// Shifts (m) of all boxes of so many rings along x and along y, (2 rings_x + 1) (2 rings_y + 1) of them, the cell's
/// own zero shift included, in a fixed order. The offset must be folded.
std::vector<Vec3> image_shifts(const ShearingBox& box, double offset, int rings_x, int rings_y);

/// The image of a position that lies in the cell. The offset must be folded.
Vec3 into_cell(const ShearingBox& box, double offset, const Vec3& position);

} // namespace keeler
