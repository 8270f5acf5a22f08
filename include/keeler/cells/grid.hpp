// The search structure: points binned into cells of the sheared-periodic box, in x and y (rings are thin).
// Invariants: every point lies in exactly one cell; a query visits every image of every point inside its window at
// least once and each image at most once, also across edges and when the window is wider than the box.
#pragma once

#include <keeler/box/shearing_box.hpp>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

class PeriodicGrid {
public:
  /// Bins points at an instant when the box's shear offset is `offset`. Cells are squares of about `cell_size` (m),
  /// made larger when there would be more than two a point.
  void build(std::span<const Vec3> points, const ShearingBox& box, double offset, double cell_size);

  /// Calls visit(j, image) for every image of every point j with |x_j' − x| <= reach_x and |y_j' − y| <= reach_y, where
  /// (x_j', y_j') = point j + box.displacement(image, offset). The point itself is visited like any other.
  template<class Visit> void visit_near(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const {
    visit_cells<true>(point, reach_x, reach_y, visit);
  }

  /// The same for everything in the cells that this window touches: what a grid alone can say.
  template<class Visit>
  void visit_touched_cells(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const {
    visit_cells<false>(point, reach_x, reach_y, visit);
  }

private:
  template<bool inside_window, class Visit>
  void visit_cells(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const;

  struct Entry {
    double x, y; // inside the cell
    std::uint32_t point;
    Image home; // the image of the point that lies inside the cell
  };

  ShearingBox box_;
  double offset_ = 0.0;
  std::int64_t columns_ = 1, rows_ = 1;
  double per_x_ = 1.0, per_y_ = 1.0; // cells a metre
  std::vector<std::uint32_t> first_; // first entry of each cell, column by column
  std::vector<Entry> entries_;
};

/// Quotient and remainder rounded towards minus infinity.
struct FloorDivision {
  std::int64_t quotient, remainder;
  FloorDivision(std::int64_t value, std::int64_t by) : quotient(value / by), remainder(value % by) {
    if (remainder < 0) {
      remainder += by;
      --quotient;
    }
  }
};

template<bool inside_window, class Visit>
void PeriodicGrid::visit_cells(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const {
  const double left = point.x() + 0.5 * box_.size_x - reach_x, right = left + 2.0 * reach_x;
  const auto first_column = static_cast<std::int64_t>(std::floor(left * per_x_));
  const auto last_column = static_cast<std::int64_t>(std::floor(right * per_x_));
  for (std::int64_t c = first_column; c <= last_column; ++c) {
    const FloorDivision column(c, columns_); // quotient: how many boxes outward
    const double shift_x = static_cast<double>(column.quotient) * box_.size_x;
    const double shift_y = -static_cast<double>(column.quotient) * offset_;
    const double low = point.y() + 0.5 * box_.size_y - shift_y - reach_y, high = low + 2.0 * reach_y;
    const auto first_row = static_cast<std::int64_t>(std::floor(low * per_y_));
    const auto last_row = static_cast<std::int64_t>(std::floor(high * per_y_));
    for (std::int64_t r = first_row; r <= last_row; ++r) {
      const FloorDivision row(r, rows_);
      const double x = point.x() - shift_x;
      const double y = point.y() - shift_y - static_cast<double>(row.quotient) * box_.size_y;
      const std::size_t cell = static_cast<std::size_t>(column.remainder * rows_ + row.remainder);
      for (std::uint32_t k = first_[cell]; k < first_[cell + 1]; ++k) {
        const Entry& e = entries_[k];
        if (!inside_window || (std::fabs(e.x - x) <= reach_x && std::fabs(e.y - y) <= reach_y))
          visit(std::size_t{e.point}, Image{e.home.nx + static_cast<std::int32_t>(column.quotient),
                                            e.home.ny + static_cast<std::int32_t>(row.quotient)});
      }
    }
  }
}

} // namespace keeler
