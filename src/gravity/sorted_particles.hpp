// The particles sorted by tile (a tile is a square of whole mesh cells in x and y), within a tile by height, then by
// id. The order depends on the problem alone, and so do sums taken in this order.
#pragma once

#include "mesh_kernels.hpp"

#include <keeler/cells/sheared_cells.hpp>
#include <keeler/core/memory.hpp>
#include <keeler/gravity/solver.hpp>

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::gravity {

/// Tiles are numbered column by column: tile (a, b) holds cells a × side … of x and b × side … of y.
struct Tiling {
  std::size_t columns = 0, rows = 0; ///< cells of the box
  std::size_t side = 1;              ///< cells per tile and axis; the last tiles may have fewer

  std::size_t tile_columns() const { return (columns + side - 1) / side; }
  std::size_t tile_rows() const { return (rows + side - 1) / side; }
  std::size_t count() const { return tile_columns() * tile_rows(); }
};

/// Finds the tile of a position inside the cell.
class TileFinder {
public:
  TileFinder(const Tiling& tiling, const ShearingBox& box)
      : tiling_(tiling), left_(-0.5 * box.size_x), bottom_(-0.5 * box.size_y),
        columns_per_metre_(static_cast<double>(tiling.columns) / box.size_x),
        rows_per_metre_(static_cast<double>(tiling.rows) / box.size_y), tile_rows_(tiling.tile_rows()) {
    assert(tiling.side > 0 && tiling.columns > 0 && tiling.rows > 0);
  }

  std::size_t column(double x) const {
    return cells::cell_of(x, left_, columns_per_metre_, tiling_.columns) / tiling_.side;
  }
  std::size_t tile(double x, double y) const {
    return column(x) * tile_rows_ + cells::cell_of(y, bottom_, rows_per_metre_, tiling_.rows) / tiling_.side;
  }

private:
  Tiling tiling_;
  double left_, bottom_, columns_per_metre_, rows_per_metre_;
  std::size_t tile_rows_;
};

/// Consecutive columns of tiles, periodically: the first column of the box follows its last one.
struct TileColumns {
  std::size_t begin = 0, count = 0;
};

/// A particle folded into the cell, as ranks exchange it.
struct FoldedParticle {
  double x, y, z; ///< m
  double mass;    ///< kg
  std::uint64_t id;
};

/// Resizes scratch memory. If it must grow, its contents are lost and 1/16 more is reserved: the number of particles of
/// a rank changes with each solve.
template<class Row> void resize_scratch(std::vector<Row>& rows, std::size_t count) {
  if (rows.capacity() < count) {
    free_memory(rows);
    rows.reserve(count + count / 16);
  }
  rows.resize(count);
}

class SortedParticles {
public:
  /// Sorts all particles. Precondition: the offset is folded (images.hpp).
  void sort(const GravityProblem& problem, double offset, const Tiling& tiling);

  /// Sorts a part of the box. Precondition: `particles` are all particles in these columns of tiles. Only tiles in
  /// these columns may be queried.
  void sort(std::span<const FoldedParticle> particles, const ShearingBox& box, const Tiling& tiling,
            const TileColumns& columns, double mass_unit);

  const Tiling& tiling() const { return tiling_; }
  std::size_t count() const { return index_.size(); }

  /// Particles of tile t are [first(t), end(t)); the next tile of the column follows.
  std::size_t first(std::size_t tile) const {
    assert(local_tile(tile) + 1 < first_.size());
    return first_[local_tile(tile)];
  }
  std::size_t end(std::size_t tile) const {
    assert(local_tile(tile) + 1 < first_.size());
    return first_[local_tile(tile) + 1];
  }

  /// Positions inside the cell; masses in units of mass_unit().
  ParticleRange range(std::size_t begin, std::size_t count) const {
    assert(begin + count <= index_.size());
    return {x_.data() + begin, y_.data() + begin, z_.data() + begin, mass_.data() + begin, count};
  }

  std::uint32_t index(std::size_t k) const { return index_[k]; } ///< of sorted particle k in the arrays given

  double mass_unit() const { return mass_unit_; } ///< the mean mass, kg

  /// Releases the memory of positions and masses. The order is kept: the next sort() begins with it.
  void release();

private:
  struct Entry {
    double x, y, z;
    std::uint32_t index;
  };

  /// Numbers the tiles from the first of the columns given to sort().
  std::size_t local_tile(std::size_t tile) const {
    return tile >= first_tile_ ? tile - first_tile_ : tile + tiles_behind_;
  }
  template<class Source> void sort_source(const Source& source, const ShearingBox& box, const TileColumns& columns);

  Tiling tiling_;
  std::size_t first_tile_ = 0;   // of the columns given to sort()
  std::size_t tiles_behind_ = 0; // from that tile to the end of the box
  std::vector<std::uint32_t> first_, index_;
  std::vector<double> x_, y_, z_;
  std::vector<float> mass_;
  double mass_unit_ = 1.0;
};

} // namespace keeler::gravity
