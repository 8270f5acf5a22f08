#include <keeler/gravity/images.hpp>

#include <cassert>
#include <cmath>

namespace keeler::gravity {

double folded_offset(const ShearingBox& box, double offset) {
  assert(box.size_y > 0.0);
  return std::remainder(offset, box.size_y);
}

std::vector<Vec3> image_shifts(const ShearingBox& box, double offset, int rings_x, int rings_y) {
  assert(rings_x >= 0 && rings_y >= 0 && std::fabs(offset) <= 0.5 * box.size_y);
  std::vector<Vec3> shifts;
  for (int nx = -rings_x; nx <= rings_x; ++nx) {
    const int middle = static_cast<int>(std::nearbyint(nx * offset / box.size_y));
    for (int ny = middle - rings_y; ny <= middle + rings_y; ++ny)
      shifts.push_back(box.displacement({nx, ny}, offset));
  }
  return shifts;
}

Vec3 into_cell(const ShearingBox& box, double offset, const Vec3& position) {
  assert(!(std::fabs(offset) > 0.5 * box.size_y)); // folded
  const Image image = box.image_into_cell(position.x(), position.y(), offset);
  return position + box.displacement(image, offset);
}

} // namespace keeler::gravity
