#include <keeler/cells/grid.hpp>

#include <keeler/core/counting_sort.hpp>

#include <algorithm>
#include <cassert>

namespace keeler::cells {
void PeriodicGrid::build(std::span<const Vec3> points, const ShearingBox& box, double offset, double cell_size) {
  assert(box.size_x > 0.0 && box.size_y > 0.0);
  const double min_size = std::sqrt(box.area() / (2.0 * static_cast<double>(points.size()) + 1.0));
  const auto axis = [size = std::max(cell_size, min_size)](double length) {
    const double cells = std::max(1.0, std::floor(length / size));
    return CellAxis(length, length / cells, static_cast<std::size_t>(cells));
  };
  cells_ = {box, offset, axis(box.size_x), axis(box.size_y)};
  std::vector<Entry> unsorted(points.size());
  std::vector<std::uint32_t> cell_of(points.size());
  parallel_for(points.size(), [&](std::size_t k) {
    const Image home = box.image_into_cell(points[k].x(), points[k].y(), offset);
    const Vec3 inside = points[k] + box.displacement(home, offset);
    unsorted[k] = {inside.x(), inside.y(), static_cast<std::uint32_t>(k), home};
    cell_of[k] = static_cast<std::uint32_t>(cells_.cell(inside.x(), inside.y()));
  });
  entries_.resize(points.size());
  counting_sort(cell_of, cells_.count(), first_,
                [&](std::size_t k, std::size_t position) { entries_[position] = unsorted[k]; });
}

} // namespace keeler::cells
