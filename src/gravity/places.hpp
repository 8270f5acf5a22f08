// The particles in the order of their places: tile by tile (tiles are squares of whole mesh cells, in x and y), by
// height within a tile. The order depends on the problem alone, and sums in this order do too.
#pragma once

#include "mesh_kernels.hpp"

#include <keeler/cells/sheared_cells.hpp>
#include <keeler/gravity/solver.hpp>

#include <cstdint>
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

class Places {
public:
  /// The offset must be folded (images.hpp).
  void sort(const GravityProblem& problem, double offset, const Tiling& tiling);

  const Tiling& tiling() const { return tiling_; }
  std::size_t count() const { return index_.size(); }

  /// Particles of tile t stand in [first(t), first(t + 1)).
  std::size_t first(std::size_t tile) const { return first_[tile]; }

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
  std::vector<Place> found_, sorted_; // kept for their memory
  Tiling tiling_;
  std::vector<std::uint32_t> tile_of_, first_, index_;
  std::vector<double> x_, y_, z_;
  std::vector<float> mass_;
  double mass_unit_ = 1.0;
};

} // namespace keeler
