// Fills what the kernels in single precision read. Apart from kernels.hpp, whose readers may hold no inline functions.
#pragma once

#include "kernels.hpp"

#include <bit>

namespace keeler {

/// Parts a place into what a float holds of it and what is left: |place − high − low| < 2^-46 |place|.
inline void split_place(double place, float& high, float& low) {
  // not by way of (double)(float)place: gcc 12 may take that for place itself when it vectorises
  const double cut = std::bit_cast<double>(std::bit_cast<std::uint64_t>(place) & 0xffffffffe0000000);
  high = static_cast<float>(cut); // exactly
  low = static_cast<float>(place - cut);
}

inline SinglePoint single_point(const PointSource& source) {
  SinglePoint point{};
  split_place(source.x, point.x, point.x_low);
  split_place(source.y, point.y, point.y_low);
  split_place(source.z, point.z, point.z_low);
  point.mass = static_cast<float>(source.mass);
  return point;
}

/// Writes entry k.
inline void put(FarCells& cells, std::size_t k, const CellSource& cell) {
  cells.x[k] = cell.x;
  cells.y[k] = cell.y;
  cells.z[k] = cell.z;
  cells.mass[k] = cell.mass;
  cells.xx[k] = cell.xx;
  cells.yy[k] = cell.yy;
  cells.zz[k] = cell.zz;
  cells.xy[k] = cell.xy;
  cells.xz[k] = cell.xz;
  cells.yz[k] = cell.yz;
}

} // namespace keeler
