// A tree of cells over particles, each cell with its mass, centre of mass and quadrupole.
//
// Invariants: cells are in preorder (a cell, its first child's subtree, its second child's subtree), so `span` skips a
// subtree. The particles of a cell are one contiguous range, split between its two children. Its box is tight around
// their positions rounded to floats. Which particles share a cell depends on their positions alone, and within a leaf
// they are sorted by x (as floats), then by id: sums over a tree do not depend on the order of the input.
//
// A walk reads 32 bytes per cell; boxes and moments are stored apart.
#pragma once

#include "kernels.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace keeler::gravity {

struct TreeCell {
  float x, y, z;           ///< centre of mass
  float size;              ///< longest side of the box, m
  float reach;             ///< distance from the centre of mass to the farthest corner of the box, m
  std::uint32_t begin = 0; ///< its particles are [begin, begin + count)
  std::uint32_t count = 0;
  std::uint32_t span = 1; ///< cells of this subtree, itself included; 1 for a leaf

  bool is_leaf() const { return span == 1; }
};

/// The tight box of a cell, m.
struct CellBox {
  float low[3], high[3];
};

/// The centre of mass is (x, y, z) of the cell plus (x_low, y_low, z_low). Masses are in the tree's unit.
struct CellMoments {
  float x_low, y_low, z_low;
  float mass;
  float xx, yy, zz, xy, xz, yz; ///< traceless quadrupole Σ m (3 d dᵀ − d² 1) about the centre, m²
};

class CellTree {
public:
  static constexpr std::uint32_t leaf_size = 8;
  static constexpr int max_depth = 128;

  /// Builds the tree. Cells of more than leaf_size particles are split in the middle of the longest side of their box,
  /// unless all their positions are equal (as floats) or the tree would become deeper than max_depth. Particle k has
  /// the id ids[indices[k]]. Any order of the particles will do; it is fast if neighbours follow each other.
  void build(std::span<const PointSource> particles, std::span<const std::uint32_t> indices,
             std::span<const std::uint64_t> ids);

  /// The particles in the tree's order, and the index of each of them in ids.
  const std::vector<PointSource>& particles() const { return particles_; }
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// particles() for kernels in single precision, masses in the tree's unit.
  const std::vector<SinglePoint>& points() const { return points_; }

  /// The largest mass, kg; 1 if all are zero.
  double mass_unit() const { return mass_unit_; }

  const std::vector<TreeCell>& cells() const { return cells_; }
  const std::vector<CellBox>& boxes() const { return boxes_; }
  const std::vector<CellMoments>& moments() const { return moments_; }

private:
  std::vector<PointSource> particles_;
  std::vector<std::uint32_t> order_;
  std::vector<SinglePoint> points_;
  std::vector<TreeCell> cells_;
  std::vector<CellBox> boxes_;
  std::vector<CellMoments> moments_;
  double mass_unit_ = 1.0;
};

} // namespace keeler::gravity
