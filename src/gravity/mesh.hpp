// The mesh of the smooth part: cells over the box, nodes at their corners, planes of nodes over the particles' heights;
// mass assignment to the nodes.
//
// A particle has weights in the 4 × 4 × 4 nodes around it, by cubic splines (order 4, "PCS"). Its force is the exact
// gradient of the interpolated potential, so one potential serves all three components. Layout: column after column of
// nodes (one x), in a column plane by plane, in a plane row by row along y. Node I of x, J of y, K of z is at the lower
// corner of cell I − 1, J − 1, K − 1. Behind the last columns and rows of the box are ghosts that take what particles
// in the last cells spread beyond: nodes columns … columns + 2, rows … rows + 2.
#pragma once

#include "aligned_array.hpp"
#include "index_range.hpp"
#include "mesh_kernels.hpp"
#include "sorted_particles.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <cassert>

namespace keeler::gravity {

struct MeshShape {
  static constexpr std::size_t order = 4;
  static constexpr std::size_t ghosts = order - 1;

  std::size_t columns = 0, rows = 0; ///< cells of the box in x and y
  std::size_t planes = 0;            ///< nodes in z
  double step_x = 0.0, step_y = 0.0; ///< spacings, m
  double step_z = 0.0;
  double per_x = 0.0, per_y = 0.0;             ///< cells per metre
  double left = 0.0, bottom = 0.0, base = 0.0; ///< corner of cell 0, 0, 0, m

  double area() const { return step_x * static_cast<double>(columns) * (step_y * static_cast<double>(rows)); }

  /// Floats from one row to the next: rows begin at cache lines.
  std::size_t row_length() const { return (rows + ghosts + 15) / 16 * 16; }
  std::size_t column_length() const { return planes * row_length(); }
};

/// Returns the mesh that covers the box with cells of at most `spacing`, and the heights [low, high] with planes at
/// exactly `plane_spacing`. The numbers of cells have fast transforms.
MeshShape mesh_shape(const ShearingBox& box, double spacing, double plane_spacing, double low, double high);

/// The values at the nodes of all columns or of a range of columns.
class Mesh {
public:
  /// Sets the shape and zeroes the values: of all columns including ghosts, or of a range.
  void reset(const MeshShape& shape) { reset(shape, {0, shape.columns + MeshShape::ghosts}); }
  void reset(const MeshShape& shape, const IndexRange& columns);

  /// Releases the memory and with it all values.
  void release_memory() { values_ = AlignedArray<float>(); }

  /// There is memory for so many columns behind the last one: a spectrum in the mesh's memory has whole blocks.
  static constexpr std::size_t spare_columns = 7;

  const MeshShape& shape() const { return shape_; }
  float* column(std::size_t i) {
    assert(i >= first_column_);
    return values_.data() + (i - first_column_) * shape_.column_length();
  }

  /// Returns the width in columns of tiles of a slab, which one thread fills: as wide as its neighbour spreads into it.
  static std::size_t slab(const Tiling& tiling) { return (MeshShape::ghosts + tiling.side - 1) / tiling.side; }

  /// Adds the particles' masses. Even slabs are filled first, in parallel, then odd ones: the order of the sum at each
  /// node depends on the particles' order alone.
  void spread(const SortedParticles& sorted, const MeshKernels& kernels) {
    spread(sorted, {0, sorted.tiling().tile_columns()}, kernels);
  }
  /// Adds the masses in a range of columns of tiles. Precondition: the range begins a slab, counted from column 0.
  void spread(const SortedParticles& sorted, const IndexRange& tile_columns, const MeshKernels& kernels);

  MeshView view();

private:
  MeshShape shape_;
  std::size_t first_column_ = 0;
  AlignedArray<float> values_;
};

} // namespace keeler::gravity
