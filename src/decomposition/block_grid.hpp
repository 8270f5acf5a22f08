// The blocks of the ranks: strips divide the box across x, and each strip is cut along y into the blocks of consecutive
// ranks. With as many strips as ranks the blocks are slabs.
//
// Invariant: each position of the cell is in exactly one block. A block may be empty.
#pragma once

#include <keeler/comm/communicator.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::decomposition {

/// A position in the plane, or a distance along x and y, m.
struct Point {
  double x = 0.0, y = 0.0;
};

class BlockGrid {
public:
  /// Equal blocks, as many slabs as ranks.
  BlockGrid(const ShearingBox& box, std::size_t ranks) : box_(box), ranks_(ranks) { divide(ranks); }

  /// Divides the box into equal blocks in a number of strips from 1 to the number of ranks.
  void divide(std::size_t strips);
  std::size_t strips() const { return first_.size() - 1; }
  /// True if a strip has several blocks.
  bool has_rows() const { return strips() < ranks_; }

  /// Returns what a division into equal blocks costs: ghosts within `reach` of a block over own particles, and the
  /// particles that gravity's mesh, which is divided across x alone, sends to other ranks than their owner.
  double cost(std::size_t strips, const Point& reach) const;
  /// Returns the number of strips with the least cost.
  std::size_t best_strips(const Point& reach) const;

  /// Moves the bounds of the blocks so that the weights of all ranks' particles are equal. Does nothing if the largest
  /// weight of a block is near the mean. Collective.
  void balance(std::span<const Point> positions, std::span<const std::uint64_t> weights, const Communicator& ranks);

  /// Returns the rank of the block that contains a position of the cell.
  std::size_t owner(const Point& position) const;
  /// True if an image of the position may be within `reach` of the rank's block.
  bool is_within(const Point& position, std::size_t rank, const Point& reach, double offset) const {
    return meet({position, {}}, block(rank), reach, offset);
  }
  /// Returns the size of the rank's block, m.
  Point size(std::size_t rank) const {
    const Block its = block(rank);
    return {2.0 * its.half_size.x, 2.0 * its.half_size.y};
  }
  /// Returns the other ranks with blocks that may be within `reach` of the rank's block, ascending.
  std::vector<std::size_t> neighbours(std::size_t rank, const Point& reach, double offset) const;

private:
  struct Block {
    Point middle, half_size;
  };

  std::size_t strip_of(std::size_t rank) const;
  Block block(std::size_t rank) const;
  bool meet(const Block& a, const Block& b, const Point& reach, double offset) const;

  ShearingBox box_;
  std::size_t ranks_;
  std::vector<std::size_t> first_;            // rank of each strip, then the number of ranks
  std::vector<double> x_bounds_;              // strip s is [x_bounds_[s], x_bounds_[s + 1]), m; ascending
  std::vector<std::vector<double>> y_bounds_; // of the blocks of each strip, likewise
};

} // namespace keeler::decomposition
