#include <keeler/hill/shearing_box.hpp>

#include <cmath>

namespace keeler {
namespace {

// The box that a place lies in, given in box lengths. Places too far for the number of a box, or that are not numbers,
// get one that does not bring them into the cell: who asks refuses them.
std::int32_t nearest_box(double place) {
  constexpr double farthest = 1 << 30;
  return static_cast<std::int32_t>(std::fmax(-farthest, std::fmin(farthest, std::floor(place + 0.5))));
}

} // namespace

double ShearingBox::offset(std::int64_t half_steps, double half_step) const {
  // count × displacement as an unevaluated sum of two doubles; fmod of each part is exact.
  const double count = static_cast<double>(half_steps);
  const double per_half_step = shear * size_x * half_step;
  const double product = count * per_half_step;
  const double rest = std::fma(count, per_half_step, -product);
  double d = std::fmod(std::fmod(product, size_y) + rest + first_offset, size_y);
  if (d < 0.0)
    d += size_y;
  return d < size_y ? d : 0.0;
}

Image ShearingBox::far_image_into_cell(double x, double y, double offset) const {
  Image image;
  image.nx = -nearest_box(x / size_x);
  image.ny = -nearest_box((y - image.nx * offset) / size_y);
  return image;
}

} // namespace keeler
