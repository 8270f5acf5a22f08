#include "mesh_choice.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/format.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace keeler::gravity {

Extent extent_of(std::span<const Vec3> positions) {
  if (!std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); }))
    throw InvariantError("the position of a particle is not finite; take a shorter time.step");
  Extent z{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Vec3& p : positions) {
    z.low = std::min(z.low, p.z());
    z.high = std::max(z.high, p.z());
  }
  return z;
}

void require_layer(const ShearingBox& box, const Extent& z) {
  constexpr double max_sides = 1000.0;
  const double farthest = std::max(-z.low, z.high), side = std::min(box.size_x, box.size_y);
  if (farthest > max_sides * side)
    throw InvariantError(
        fmt::format("a particle is {} sides of the box away from the mid-plane, and gravity's mesh reaches to it "
                    "(at most {} sides); remove it, or take a shorter time.step",
                    format_number(farthest / side, 3), max_sides));
}

double mesh_nodes(const ShearingBox& box, double spacing, const Extent& z) {
  assert(spacing > 0.0);
  return box.size_x / spacing * (box.size_y / spacing) * ((z.high - z.low) / (plane_spacing_ratio * spacing) + 4.0);
}

double max_mesh_nodes(std::size_t count) {
  return 0x1p21 + 64.0 * static_cast<double>(count);
}

double affordable_spacing(const ShearingBox& box, double spacing, const Extent& z, std::size_t count) {
  while (mesh_nodes(box, spacing, z) > max_mesh_nodes(count))
    spacing *= 1.1;
  return spacing;
}

Tiling tiling_for(const MeshShape& shape, std::size_t count) {
  assert(count > 0);
  const double cells = static_cast<double>(shape.columns) * static_cast<double>(shape.rows);
  const double side = std::round(std::sqrt(8.0 * cells / static_cast<double>(count)));
  const double max_side = static_cast<double>(std::max(shape.columns, shape.rows));
  return {shape.columns, shape.rows, static_cast<std::size_t>(std::clamp(side, 1.0, max_side))};
}

} // namespace keeler::gravity
