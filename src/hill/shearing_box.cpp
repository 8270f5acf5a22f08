#include <keeler/hill/shearing_box.hpp>

#include <cassert>

namespace keeler::hill {
namespace {

// Returns the index of the box in which a coordinate, in box lengths, lies. It is limited to ±2³⁰, also for NaN; such
// coordinates are not brought into the cell, and the caller rejects them.
std::int32_t nearest_box(double coordinate) {
  constexpr double max_index = 1 << 30;
  return static_cast<std::int32_t>(std::fmax(-max_index, std::fmin(max_index, std::floor(coordinate + 0.5))));
}

} // namespace

double ShearingBox::offset(std::int64_t half_steps, double half_step) const {
  assert(std::isfinite(half_step));
  // The product count × displacement is an unevaluated sum of two doubles; fmod of each part is exact.
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

} // namespace keeler::hill
