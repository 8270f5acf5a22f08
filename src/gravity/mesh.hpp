// The mesh of the smooth part: cells over the box, nodes at their corners, planes of nodes over the particles' heights;
// how particles are spread on it and feel its values.
//
// A particle has a share in the 4 × 4 × 4 nodes around it, by cubic splines (order 4, "PCS"): its force is the exact
// gradient of the interpolated potential, so one potential serves all three components. Columns of nodes (one x) stand
// one behind the other, in a column plane by plane, in a plane row by row along y. Node I of a column, J of a row, K of
// the planes stands at the lower corner of cell I − 1, J − 1, K − 1. Behind the last columns and rows of the box stand
// ghosts that take what particles in the last cells spread beyond: nodes columns … columns + 2, rows … rows + 2.
#pragma once

#include "aligned_array.hpp"
#include "index_range.hpp"
#include "mesh_kernels.hpp"
#include "places.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <utility>

namespace keeler {

struct MeshShape {
  static constexpr std::size_t order = 4;
  static constexpr std::size_t ghosts = order - 1;

  std::size_t columns = 0, rows = 0; ///< cells of the box in x and y
  std::size_t planes = 0;            ///< nodes in z
  double step_x = 0.0, step_y = 0.0; ///< spacings, m
  double step_z = 0.0;
  double per_x = 0.0, per_y = 0.0;             ///< cells a metre
  double left = 0.0, bottom = 0.0, base = 0.0; ///< corner of cell 0, 0, 0

  double area() const { return step_x * static_cast<double>(columns) * (step_y * static_cast<double>(rows)); }

  /// Floats from one row to the next: rows begin on cache lines.
  std::size_t row_length() const { return (rows + ghosts + 15) / 16 * 16; }
  std::size_t column_length() const { return planes * row_length(); }
};

/// The mesh that covers the box with cells of at most this size, and the heights from `low` to `high` with planes at
/// just that distance. Sizes are such that transforms are fast.
MeshShape mesh_shape(const ShearingBox& box, double spacing, double plane_spacing, double low, double high);

/// The values at the nodes, of all columns or of a range.
class Mesh {
public:
  /// All zero, of that shape: all columns, ghosts too, or these.
  void reset(const MeshShape& shape) { reset(shape, {0, shape.columns + MeshShape::ghosts}); }
  void reset(const MeshShape& shape, const IndexRange& columns);

  /// Gives up all values, and the memory that they are in; and takes it back.
  AlignedArray<float> take_memory() { return std::move(values_); }
  void give_memory(AlignedArray<float> memory) { values_ = std::move(memory); }

  const MeshShape& shape() const { return shape_; }
  float* column(std::size_t i) { return values_.data() + (i - first_column_) * shape_.column_length(); }

  /// Columns of tiles that are filled by one thread, a slab: as wide as what its neighbour spreads into it.
  static std::size_t slab(const Tiling& tiling) { return (MeshShape::ghosts + tiling.side - 1) / tiling.side; }

  /// Adds the particles' masses. Slabs of the box are filled side by side, every other one first: the order of each
  /// node's sum depends on the places alone.
  void spread(const Places& places, const MeshKernels& kernels) {
    spread(places, {0, places.tiling().tile_columns()}, kernels);
  }
  /// Of these columns of tiles alone, whole slabs counted from column 0.
  void spread(const Places& places, const IndexRange& tile_columns, const MeshKernels& kernels);

  MeshNumbers numbers();

private:
  MeshShape shape_;
  std::size_t first_column_ = 0;
  AlignedArray<float> values_;
};

} // namespace keeler
