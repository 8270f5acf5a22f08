// A cell grid for range queries: points are binned in x and y (rings are thin) into cells of the sheared-periodic box.
// Invariants: every point is in exactly one cell; a query visits every image of every point inside its window exactly
// once, also across edges and when the window is wider than the box.
#pragma once

#include <keeler/cells/sheared_cells.hpp>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::cells {

class PeriodicGrid {
public:
  /// Bins points at the instant of the shear offset `offset`. Cells are squares of about `cell_size` (m), enlarged if
  /// there were more than two per point. Precondition: box.area() > 0.
  void build(std::span<const Vec3> points, const ShearingBox& box, double offset, double cell_size);

  /// Calls visit(j, image) for every image of every point j with |x_j' − x| <= reach_x and |y_j' − y| <= reach_y, where
  /// (x_j', y_j') = point j + box.displacement(image, offset). The query point itself is included if it is in the grid.
  template<class Visit> void visit_near(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const {
    visit_cells<true>(point, reach_x, reach_y, visit);
  }

  /// Calls visit(j, image) for all points in the cells that the window intersects: a superset of visit_near().
  template<class Visit>
  void visit_touched_cells(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const {
    visit_cells<false>(point, reach_x, reach_y, visit);
  }

private:
  template<bool inside_window, class Visit>
  void visit_cells(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const;

  struct Entry {
    double x, y; // of the image in the cell of the box
    std::uint32_t point;
    Image home; // that image
  };

  ShearedCells cells_;
  std::vector<std::uint32_t> first_; // first entry of each cell, and the number of entries
  std::vector<Entry> entries_;
};

template<bool inside_window, class Visit>
void PeriodicGrid::visit_cells(const Vec3& point, double reach_x, double reach_y, const Visit& visit) const {
  const auto window_y = [&](double) { return std::pair(point.y() - reach_y, point.y() + reach_y); };
  cells_.visit_window(
      point.x() - reach_x, point.x() + reach_x, window_y, [&](std::size_t first, std::size_t last, const Image& image) {
        const Vec3 there = point - cells_.box.displacement(image, cells_.offset);
        for (std::uint32_t k = first_[first]; k < first_[last + 1]; ++k) {
          const Entry& e = entries_[k];
          if (!inside_window || (std::fabs(e.x - there.x()) <= reach_x && std::fabs(e.y - there.y()) <= reach_y))
            visit(std::size_t{e.point}, Image{e.home.nx + image.nx, e.home.ny + image.ny});
        }
      });
}

} // namespace keeler::cells
