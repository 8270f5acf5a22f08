// Cells of the sheared-periodic box and its images, and the traversal of the cells that a window intersects.
#pragma once

#include <keeler/hill/shearing_box.hpp>

#include <cassert>
#include <cstdint>

namespace keeler::cells {

/// Returns the index of the cell of a coordinate, for `cells` cells that begin at `low`. Coordinates outside, also by
/// rounding, get the first or last cell. Precondition: cells > 0.
inline std::size_t cell_of(double coordinate, double low, double cells_per_metre, std::size_t cells) {
  const double position = (coordinate - low) * cells_per_metre; // in cells
  const auto cell = position > 0.0 ? static_cast<std::size_t>(position) : 0;
  return cell < cells ? cell : cells - 1;
}

/// Cells of equal width along one axis of the box; the edge may truncate the last one.
struct CellAxis {
  CellAxis() = default;
  CellAxis(double box_size, double cell_width, std::size_t cells)
      : low(-0.5 * box_size), per_box(1.0 / box_size), width(cell_width), per_cell(1.0 / cell_width), count(cells) {
    assert(box_size > 0.0 && cell_width > 0.0 && cells > 0);
  }

  std::size_t cell(double coordinate) const { return cell_of(coordinate, low, per_cell, count); }
  double begin(std::size_t cell) const { return low + static_cast<double>(cell) * width; }

  /// Returns the index of the box in which a coordinate lies; 0 is the box itself.
  std::int64_t box(double coordinate) const {
    const double boxes = (coordinate - low) * per_box;
    const auto whole = static_cast<std::int64_t>(boxes);
    return static_cast<double>(whole) > boxes ? whole - 1 : whole; // floor() without a library call
  }

  double low = 0.0, per_box = 1.0, width = 1.0, per_cell = 1.0;
  std::size_t count = 1;
};

/// All cells, numbered by column: the rows of a column are consecutive. `offset` is the shear offset of the box.
struct ShearedCells {
  ShearingBox box;
  double offset = 0.0;
  CellAxis x, y;

  std::size_t count() const { return x.count * y.count; }
  std::size_t cell(double inside_x, double inside_y) const { return x.cell(inside_x) * y.count + y.cell(inside_y); }

  /// Visits the columns that intersect [low_x, high_x] and, in each, the rows that intersect window_y(x) = (low, high),
  /// where x is the beginning of the column. Calls visit(first, last, image) for the cells first … last, displaced by
  /// `image`. Each cell of each image is visited at most once. Precondition: low_x <= high_x.
  template<class Window, class Visit>
  void visit_window(double low_x, double high_x, const Window& window_y, const Visit& visit) const {
    assert(!(low_x > high_x));
    const std::int64_t last_nx = x.box(high_x);
    for (std::int64_t nx = x.box(low_x); nx <= last_nx; ++nx) {
      const double boxes_x = static_cast<double>(nx), shift_x = boxes_x * box.size_x;
      const std::size_t last_column = x.cell(high_x - shift_x);
      for (std::size_t column = x.cell(low_x - shift_x); column <= last_column; ++column) {
        const auto [low_y, high_y] = window_y(x.begin(column) + shift_x);
        const double low = low_y + boxes_x * offset, high = high_y + boxes_x * offset; // in the frame of the image
        const std::int64_t last_ny = y.box(high);
        for (std::int64_t ny = y.box(low); ny <= last_ny; ++ny) {
          const double shift_y = static_cast<double>(ny) * box.size_y;
          visit(column * y.count + y.cell(low - shift_y), column * y.count + y.cell(high - shift_y),
                Image{static_cast<std::int32_t>(nx), static_cast<std::int32_t>(ny)});
        }
      }
    }
  }
};

} // namespace keeler::cells
