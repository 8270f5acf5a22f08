#include "mesh.hpp"

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace keeler {
namespace {

// 2^a 3^b 5^c, even; a multiple of 4 once that costs little.
bool transforms_fast(std::size_t n) {
  if (n % (n >= 96 ? 4 : 2) != 0)
    return false;
  for (const std::size_t prime : {2u, 3u, 5u})
    while (n % prime == 0)
      n /= prime;
  return n == 1;
}

// In boxes of a few spacings a particle's own images stand in the same place of their cells as itself, and their errors
// add up: such boxes get finer meshes, which cost next to nothing.
constexpr std::size_t fewest_cells = 8;

std::size_t fast_size(double length, double spacing) {
  auto n = std::max(fewest_cells, static_cast<std::size_t>(std::ceil(length / spacing)));
  while (!transforms_fast(n))
    ++n;
  return n;
}

} // namespace

MeshShape mesh_shape(const ShearingBox& box, double spacing, double plane_spacing, double low, double high) {
  MeshShape shape;
  shape.columns = fast_size(box.size_x, spacing);
  shape.rows = fast_size(box.size_y, spacing);
  shape.step_x = box.size_x / static_cast<double>(shape.columns);
  shape.step_y = box.size_y / static_cast<double>(shape.rows);
  shape.step_z = plane_spacing;
  shape.per_x = static_cast<double>(shape.columns) / box.size_x; // as the tiles have it, to the bit (places.hpp)
  shape.per_y = static_cast<double>(shape.rows) / box.size_y;
  shape.left = -0.5 * box.size_x;
  shape.bottom = -0.5 * box.size_y;
  const double first = std::floor(low / plane_spacing), last = std::floor(high / plane_spacing);
  shape.base = first * plane_spacing;
  shape.planes = static_cast<std::size_t>(last - first) + 1 + MeshShape::ghosts;
  return shape;
}

void Mesh::reset(const MeshShape& shape) {
  shape_ = shape;
  const std::size_t columns = shape.columns + MeshShape::ghosts;
  values_.resize_at_least(columns * shape.column_length());
  parallel_for(
      columns, [&](std::size_t i) { std::memset(column(i), 0, shape.column_length() * sizeof(float)); }, 4);
}

MeshNumbers Mesh::numbers() {
  return {values_.data(),
          shape_.column_length(),
          shape_.row_length(),
          {shape_.left, shape_.bottom, shape_.base},
          {shape_.per_x, shape_.per_y, 1.0 / shape_.step_z},
          {shape_.columns, shape_.rows, shape_.planes - MeshShape::ghosts}};
}

void Mesh::spread(const Places& places, const MeshKernels& kernels) {
  const MeshNumbers mesh = numbers();
  const Tiling& tiling = places.tiling();
  // a slab must be as wide as what its neighbour spreads into it
  const std::size_t slab = (MeshShape::ghosts + tiling.side - 1) / tiling.side;
  const std::size_t tile_columns = tiling.tile_columns(), slabs = (tile_columns + slab - 1) / slab;
  for (const std::size_t parity : {0u, 1u})
    parallel_for((slabs + 1 - parity) / 2,
                 [&](std::size_t half) {
                   const std::size_t begin = (2 * half + parity) * slab, end = std::min(begin + slab, tile_columns);
                   const std::size_t first = places.first(begin * tiling.tile_rows());
                   kernels.spread(mesh, places.range(first, places.first(end * tiling.tile_rows()) - first));
                 },
                 1);
}

} // namespace keeler
