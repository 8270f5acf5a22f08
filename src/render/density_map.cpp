#include "density_map.hpp"

#include "images.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keeler::render {
namespace {

constexpr double particles_per_cell = 4.0;

int cells(double length, double target_spacing) {
  return static_cast<int>(std::clamp(std::round(length / target_spacing), 1.0, 4096.0));
}

} // namespace

DensityMap::DensityMap(const Patch& patch) : size_x_(patch.box.size_x), size_y_(patch.box.size_y) {
  assert(patch.size() > 0);
  const double target_spacing = std::sqrt(particles_per_cell * size_x_ * size_y_ / static_cast<double>(patch.size()));
  columns_ = cells(size_x_, target_spacing);
  rows_ = cells(size_y_, target_spacing);
  spacing_x_ = size_x_ / columns_;
  spacing_y_ = size_y_ / rows_;
  values_.assign(static_cast<std::size_t>((columns_ + 2) * (rows_ + 2)), 0.0);
  for_each_image(patch, [&](std::size_t k, const Vec3& image) {
    const double column = column_of(image.x()), row = row_of(image.y());
    const double i = std::floor(column), j = std::floor(row);
    if (i < -1.0 || j < -1.0 || i > columns_ + 1 || j > rows_ + 1)
      return;
    for (const int right : {0, 1})
      for (const int up : {0, 1}) {
        const int at_i = static_cast<int>(i) + right, at_j = static_cast<int>(j) + up;
        if (at_i < 0 || at_j < 0 || at_i > columns_ + 1 || at_j > rows_ + 1)
          continue;
        const double weight = (right ? column - i : 1.0 - column + i) * (up ? row - j : 1.0 - row + j);
        node(at_i, at_j) += weight * patch.masses[k] / cell_area();
      }
  });
}

double DensityMap::at(double x, double y) const {
  const double column = column_of(x), row = row_of(y);
  const int i = std::clamp(static_cast<int>(column), 0, columns_), j = std::clamp(static_cast<int>(row), 0, rows_);
  const double u = column - i, v = row - j;
  return (1.0 - v) * ((1.0 - u) * node(i, j) + u * node(i + 1, j)) +
         v * ((1.0 - u) * node(i, j + 1) + u * node(i + 1, j + 1));
}

std::vector<double> DensityMap::inner_values() const {
  std::vector<double> inner;
  for (int j = 1; j <= rows_; ++j)
    for (int i = 1; i <= columns_; ++i)
      inner.push_back(node(i, j));
  return inner;
}

} // namespace keeler::render
