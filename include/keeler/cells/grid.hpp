// The search structure: points binned into cells of the sheared-periodic box, in x and y (rings are thin).
// Invariants: every point lies in exactly one cell; a query visits every image of every point inside its window at
// least once and each image at most once, also across edges and when the window is wider than the box.
#pragma once

#include <keeler/cells/sheared_cells.hpp>

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

  ShearedCells cells_;
  std::vector<std::uint32_t> first_; // first entry of each cell
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

} // namespace keeler
