#include <keeler/cells/grid.hpp>

#include <algorithm>

namespace keeler {
namespace {

// Of a place in units of cells; the first or the last for what rounding, or an absurd place, puts beyond them.
std::int64_t cell_number(double place, std::int64_t cells) {
  return static_cast<std::int64_t>(std::fmax(0.0, std::fmin(std::floor(place), static_cast<double>(cells - 1))));
}

} // namespace

void PeriodicGrid::build(std::span<const Vec3> points, const ShearingBox& box, double offset, double cell_size) {
  box_ = box;
  offset_ = offset;
  const double affordable = std::sqrt(box.area() / (2.0 * static_cast<double>(points.size()) + 1.0));
  const double size = std::max(cell_size, affordable);
  columns_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(box.size_x / size));
  rows_ = std::max<std::int64_t>(1, static_cast<std::int64_t>(box.size_y / size));
  per_x_ = static_cast<double>(columns_) / box.size_x;
  per_y_ = static_cast<double>(rows_) / box.size_y;

  const std::size_t cells = static_cast<std::size_t>(columns_ * rows_);
  std::vector<Entry> unsorted(points.size());
  std::vector<std::uint32_t> cell_of(points.size());
  first_.assign(cells + 1, 0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Image home = box.image_into_cell(points[k].x(), points[k].y(), offset);
    const Vec3 there = points[k] + box.displacement(home, offset);
    unsorted[k] = {there.x(), there.y(), static_cast<std::uint32_t>(k), home};
    const auto column = cell_number((there.x() + 0.5 * box.size_x) * per_x_, columns_);
    const auto row = cell_number((there.y() + 0.5 * box.size_y) * per_y_, rows_);
    cell_of[k] = static_cast<std::uint32_t>(column * rows_ + row);
    ++first_[cell_of[k] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c)
    first_[c + 1] += first_[c];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  entries_.resize(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    entries_[next[cell_of[k]]++] = unsorted[k];
}

} // namespace keeler
