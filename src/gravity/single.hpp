// Conversion to the input of kernels in single precision. Separate from kernels.hpp, which may not have inline
// functions.
#pragma once

#include "kernels.hpp"

#include <bit>
#include <cassert>

namespace keeler::gravity {

/// Splits a coordinate x into two floats: |x − high − low| < 2^-46 |x|.
inline void split_position(double x, float& high, float& low) {
  // not by (double)(float)x: gcc 12 may take that for x itself when it vectorises
  const double cut = std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) & 0xffffffffe0000000);
  high = static_cast<float>(cut); // exactly
  low = static_cast<float>(x - cut);
}

inline SinglePoint single_point(const PointSource& source) {
  SinglePoint point{};
  split_position(source.x, point.x, point.x_low);
  split_position(source.y, point.y, point.y_low);
  split_position(source.z, point.z, point.z_low);
  point.mass = static_cast<float>(source.mass);
  return point;
}

/// Writes entry k.
inline void put(FarCells& cells, std::size_t k, const CellSource& cell) {
  assert(k < FarCells::capacity);
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

} // namespace keeler::gravity
