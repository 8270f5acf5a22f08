#include "mesh.hpp"

#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

namespace keeler::gravity {
namespace {

// Returns true for 2^a 3^b 5^c, even; above 96 only multiples of 4.
bool transforms_fast(std::size_t n) {
  assert(n > 0);
  if (n % (n >= 96 ? 4 : 2) != 0)
    return false;
  for (const std::size_t prime : {2u, 3u, 5u})
    while (n % prime == 0)
      n /= prime;
  return n == 1;
}

// A lower limit for boxes of a few spacings, where a particle and its images have nearly equal positions in their cells
// and their errors add up. It costs almost nothing.
constexpr std::size_t min_cells = 8;

// Returns the smallest fast number of cells that are at most `spacing` wide.
std::size_t fast_size(double length, double spacing) {
  auto n = std::max(min_cells, static_cast<std::size_t>(std::ceil(length / spacing)));
  while (!transforms_fast(n))
    ++n;
  return n;
}

} // namespace

MeshShape mesh_shape(const ShearingBox& box, double spacing, double plane_spacing, double low, double high) {
  assert(spacing > 0.0 && plane_spacing > 0.0 && low <= high);
  MeshShape shape;
  shape.columns = fast_size(box.size_x, spacing);
  shape.rows = fast_size(box.size_y, spacing);
  shape.step_x = box.size_x / static_cast<double>(shape.columns);
  shape.step_y = box.size_y / static_cast<double>(shape.rows);
  shape.step_z = plane_spacing;
  shape.per_x = static_cast<double>(shape.columns) / box.size_x; // bitwise equal to TileFinder's
  shape.per_y = static_cast<double>(shape.rows) / box.size_y;
  shape.left = -0.5 * box.size_x;
  shape.bottom = -0.5 * box.size_y;
  const double first = std::floor(low / plane_spacing), last = std::floor(high / plane_spacing);
  shape.base = first * plane_spacing;
  shape.planes = static_cast<std::size_t>(last - first) + 1 + MeshShape::ghosts;
  return shape;
}

void Mesh::reset(const MeshShape& shape, const IndexRange& columns) {
  assert(columns.end <= shape.columns + MeshShape::ghosts);
  shape_ = shape;
  first_column_ = columns.begin;
  values_.resize_at_least((columns.size() + spare_columns) * shape.column_length());
  parallel_for(
      columns.size(),
      [&](std::size_t i) { std::memset(column(columns.begin + i), 0, shape.column_length() * sizeof(float)); }, 4);
}

MeshView Mesh::view() {
  return {values_.data(),
          first_column_,
          shape_.column_length(),
          shape_.row_length(),
          {shape_.left, shape_.bottom, shape_.base},
          {shape_.per_x, shape_.per_y, 1.0 / shape_.step_z},
          {shape_.columns, shape_.rows, shape_.planes - MeshShape::ghosts}};
}

void Mesh::spread(const SortedParticles& sorted, const IndexRange& tile_columns, const MeshKernels& kernels) {
  const MeshView mesh = view();
  const Tiling& tiling = sorted.tiling();
  assert(tile_columns.begin % slab(tiling) == 0 && tile_columns.end <= tiling.tile_columns());
  assert(tiling.columns == shape_.columns && tiling.rows == shape_.rows);
  const std::size_t width = slab(tiling), first_slab = tile_columns.begin / width;
  const std::size_t end_slab = (tile_columns.end + width - 1) / width;
  for (const std::size_t parity : {0u, 1u}) {
    const std::size_t from = first_slab + (first_slab + parity) % 2;
    parallel_for((end_slab + 1 - std::min(from, end_slab)) / 2,
                 [&](std::size_t half) {
                   const std::size_t begin = (from + 2 * half) * width;
                   const std::size_t end = std::min(begin + width, tile_columns.end);
                   const std::size_t first = sorted.first(begin * tiling.tile_rows());
                   kernels.spread(mesh, sorted.range(first, sorted.end(end * tiling.tile_rows() - 1) - first));
                 },
                 1);
  }
}

} // namespace keeler::gravity
