// The surface density of a patch on a mesh, by cloud-in-cell over all images, so that it goes on across the sheared
// edges.
#pragma once

#include <keeler/particles/patch.hpp>

#include <vector>

namespace keeler {

class DensityMap {
public:
  /// Cells of about four particles.
  explicit DensityMap(const Patch& patch);

  /// kg/m² at a place of the cell, linear between nodes.
  double at(double x, double y) const;

  /// Of the nodes inside the cell.
  std::vector<double> inner_values() const;
  double cell_area() const { return spacing_x_ * spacing_y_; }

private:
  double& node(int i, int j) { return values_[static_cast<std::size_t>(j * (columns_ + 2) + i)]; }
  double node(int i, int j) const { return values_[static_cast<std::size_t>(j * (columns_ + 2) + i)]; }
  /// In cells from the first node, which stands half a cell outside.
  double column_of(double x) const { return (x + 0.5 * size_x_) / spacing_x_ + 0.5; }
  double row_of(double y) const { return (y + 0.5 * size_y_) / spacing_y_ + 0.5; }

  double size_x_, size_y_;
  int columns_, rows_; // inside the cell; one more on each side
  double spacing_x_, spacing_y_;
  std::vector<double> values_;
};

} // namespace keeler
