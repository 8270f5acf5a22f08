// The particles in the order of their places: tile by tile (tiles are squares of whole mesh cells, in x and y), by
// height within a tile. The order depends on the problem alone, and sums in this order do too.
#pragma once

#include "mesh_kernels.hpp"

#include <keeler/cells/sheared_cells.hpp>
#include <keeler/gravity/solver.hpp>

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

/// Tiles are numbered column by column: tile (a, b) holds cells a × side … of x and b × side … of y.
struct Tiling {
  std::size_t columns = 0, rows = 0; ///< cells of the box
  std::size_t side = 1;              ///< cells of a tile; the last tiles may have fewer

  std::size_t tile_columns() const { return (columns + side - 1) / side; }
  std::size_t tile_rows() const { return (rows + side - 1) / side; }
  std::size_t count() const { return tile_columns() * tile_rows(); }
};

/// The tile of a place inside the cell.
class TileFinder {
public:
  TileFinder(const Tiling& tiling, const ShearingBox& box)
      : tiling_(tiling), left_(-0.5 * box.size_x), bottom_(-0.5 * box.size_y),
        columns_per_metre_(static_cast<double>(tiling.columns) / box.size_x),
        rows_per_metre_(static_cast<double>(tiling.rows) / box.size_y), tile_rows_(tiling.tile_rows()) {}

  std::size_t column(double x) const { return cell_of(x, left_, columns_per_metre_, tiling_.columns) / tiling_.side; }
  std::size_t tile(double x, double y) const {
    return column(x) * tile_rows_ + cell_of(y, bottom_, rows_per_metre_, tiling_.rows) / tiling_.side;
  }

private:
  Tiling tiling_;
  double left_, bottom_, columns_per_metre_, rows_per_metre_;
  std::size_t tile_rows_;
};

/// Columns of tiles side by side, round the box: behind its last column stands its first one.
struct TileColumns {
  std::size_t begin = 0, count = 0;
};

/// A particle inside the cell: what ranks tell each other of it.
struct InsideParticle {
  double x, y, z; ///< m
  double mass;    ///< kg
  std::uint64_t id;
};

/// Makes them so many rows. Where there is no room all are forgotten, and there is a little more room then than is
/// needed: how many particles a rank knows changes with each solve.
template<class Row> void resize_scratch(std::vector<Row>& rows, std::size_t count) {
  if (rows.capacity() < count) {
    rows = {};
    rows.reserve(count + count / 16);
  }
  rows.resize(count);
}

class Places {
public:
  /// The offset must be folded (images.hpp).
  void sort(const GravityProblem& problem, double offset, const Tiling& tiling);

  /// Of a part of the box: of all particles in these columns of tiles. Only tiles there may be asked for.
  void sort(std::span<const InsideParticle> particles, const ShearingBox& box, const Tiling& tiling,
            const TileColumns& known, double mass_unit);

  const Tiling& tiling() const { return tiling_; }
  std::size_t count() const { return index_.size(); }

  /// Particles of tile t stand in [first(t), end(t)); those of the next tile in the column follow.
  std::size_t first(std::size_t tile) const {
    assert(local(tile) + 1 < first_.size()); // it is known
    return first_[local(tile)];
  }
  std::size_t end(std::size_t tile) const {
    assert(local(tile) + 1 < first_.size());
    return first_[local(tile) + 1];
  }

  /// Inside the cell; masses in units of mass_unit().
  ParticleRange range(std::size_t begin, std::size_t count) const {
    return {x_.data() + begin, y_.data() + begin, z_.data() + begin, mass_.data() + begin, count};
  }

  std::uint32_t index(std::size_t k) const { return index_[k]; } ///< in the problem's arrays

  double mass_unit() const { return mass_unit_; } ///< the mean mass, kg

  /// A particle on its way into the order.
  struct Place {
    double x, y, z;
    std::uint32_t index;
  };

private:
  /// Of the known columns the first one comes first.
  std::size_t local(std::size_t tile) const { return tile >= first_known_ ? tile - first_known_ : tile + behind_; }
  template<class Source> void put_in_order(const Source& source, const ShearingBox& box, const TileColumns& known);

  std::vector<Place> found_, sorted_; // kept for their memory
  Tiling tiling_;
  std::size_t first_known_ = 0, behind_ = 0; // tiles: the first one known, how many from there to the box's end
  std::vector<std::uint32_t> tile_of_, first_, index_;
  std::vector<double> x_, y_, z_;
  std::vector<float> mass_;
  double mass_unit_ = 1.0;
};

} // namespace keeler
