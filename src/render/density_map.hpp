// The surface density of a patch on a mesh, by cloud-in-cell over all images, so that it is continuous across the
// sheared boundaries.
#pragma once

#include <keeler/particles/patch.hpp>

#include <vector>

namespace keeler::render {

class DensityMap {
public:
  /// Makes a mesh with about four particles per cell. Precondition: the patch holds a particle.
  explicit DensityMap(const Patch& patch);

  /// Returns the surface density (kg/m²) at a point of the box, interpolated between nodes.
  double at(double x, double y) const;

  /// Returns the values of the nodes inside the box.
  std::vector<double> inner_values() const;
  double cell_area() const { return spacing_x_ * spacing_y_; }

private:
  double& node(int i, int j) { return values_[static_cast<std::size_t>(j * (columns_ + 2) + i)]; }
  double node(int i, int j) const { return values_[static_cast<std::size_t>(j * (columns_ + 2) + i)]; }
  // Coordinates in cells from the first node, which is half a cell outside the box.
  double column_of(double x) const { return (x + 0.5 * size_x_) / spacing_x_ + 0.5; }
  double row_of(double y) const { return (y + 0.5 * size_y_) / spacing_y_ + 0.5; }

  double size_x_, size_y_;
  int columns_, rows_; // inside the box; one more on each side
  double spacing_x_, spacing_y_;
  std::vector<double> values_;
};

} // namespace keeler::render
