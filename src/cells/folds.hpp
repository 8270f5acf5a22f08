// Cells for particles that are in a part of the box only, those of a rank of many.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace keeler::cells {

/// The cells of a part of the box, 1/x of it across by 1/y along it, serve the whole box: it is covered by copies of
/// that part, and a cell holds what is in any copy of it. If all particles are in an area no larger than the part, then
/// hardly any cell holds particles of two copies.
struct Folds {
  std::uint32_t x = 1, y = 1;

  /// Returns the folds for particles in an area of the size `used` of a box of the size `all`, in one direction.
  static std::uint32_t of(double used, double all) {
    constexpr double most = 1 << 15;
    return static_cast<std::uint32_t>(used > 0.0 ? std::clamp(std::floor(all / used), 1.0, most) : most);
  }
};

} // namespace keeler::cells
