// Cells of the sheared-periodic box and of its images, and the one walk over those that a window touches.
#pragma once

#include <keeler/hill/shearing_box.hpp>

#include <cstdint>

namespace keeler {

/// Which of `cells` cells on a box that begins at `low` holds the coordinate: the first for what lies below, the last
/// for what lies above, where rounding may put what lies inside.
inline std::size_t cell_of(double coordinate, double low, double cells_per_metre, std::size_t cells) {
  const double place = (coordinate - low) * cells_per_metre;
  const auto cell = place > 0.0 ? static_cast<std::size_t>(place) : 0;
  return cell < cells ? cell : cells - 1;
}

/// Cells of equal width along one axis of the box; the last one may be cut off by the edge.
struct CellAxis {
  CellAxis() = default;
  CellAxis(double box_size, double cell_width, std::size_t cells)
      : low(-0.5 * box_size), per_box(1.0 / box_size), width(cell_width), per_cell(1.0 / cell_width), count(cells) {}

  std::size_t cell(double coordinate) const { return cell_of(coordinate, low, per_cell, count); }
  double begin(std::size_t cell) const { return low + static_cast<double>(cell) * width; }

  /// How many boxes outward the coordinate lies.
  std::int64_t box(double coordinate) const {
    const double boxes = (coordinate - low) * per_box;
    const auto whole = static_cast<std::int64_t>(boxes);
    return static_cast<double>(whole) > boxes ? whole - 1 : whole; // as floor() does it, without a call
  }

  double low = 0.0, per_box = 1.0, width = 1.0, per_cell = 1.0;
  std::size_t count = 1;
};

/// Numbered column by column: the rows of a column follow each other. `offset` is the box's shear offset.
struct ShearedCells {
  ShearingBox box;
  double offset = 0.0;
  CellAxis x, y;

  std::size_t count() const { return x.count * y.count; }
  std::size_t cell(double inside_x, double inside_y) const { return x.cell(inside_x) * y.count + y.cell(inside_y); }

  /// Walks over the columns that [low_x, high_x] touches and, in each of them, over the rows that the ends of
  /// window_y(x) touch; x is where the column begins. Calls visit(first, last, image): the cells first … last, as they
  /// stand displaced by that image. Each cell of each image is visited at most once.
  template<class Window, class Visit>
  void visit_window(double low_x, double high_x, const Window& window_y, const Visit& visit) const {
    const std::int64_t last_nx = x.box(high_x);
    for (std::int64_t nx = x.box(low_x); nx <= last_nx; ++nx) {
      const double boxes_x = static_cast<double>(nx), shift_x = boxes_x * box.size_x;
      const std::size_t last_column = x.cell(high_x - shift_x);
      for (std::size_t column = x.cell(low_x - shift_x); column <= last_column; ++column) {
        const auto [low_y, high_y] = window_y(x.begin(column) + shift_x);
        const double low = low_y + boxes_x * offset, high = high_y + boxes_x * offset; // in the image's column
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

} // namespace keeler
