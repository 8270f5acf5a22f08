// A tree of cells over particles, each cell with its mass, centre of mass and quadrupole.
//
// Invariants: the cells stand in preorder (a cell, its first child's subtree, its second child's subtree), so `span`
// skips a subtree; a cell's particles are one contiguous range, split between its two children; its box is tight around
// their places rounded to floats. Which particles share a cell depends on their positions alone, and within a leaf they
// stand by place and id: sums over a tree never depend on the memory order the particles came in.
//
// What a walk meets is kept small: a cell in 32 bytes, its box and its moments apart.
#pragma once

#include "kernels.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

struct TreeCell {
  float x, y, z;           ///< centre of mass
  float size;              ///< longest side of the box, m
  float reach;             ///< from the centre of mass to the farthest corner of the box, m
  std::uint32_t begin = 0; ///< first particle
  std::uint32_t count = 0; ///< particles
  std::uint32_t span = 1;  ///< cells of this subtree, itself included; 1 for a leaf

  bool is_leaf() const { return span == 1; }
};

/// A tight box.
struct CellBox {
  float low[3], high[3];
};

/// The centre of mass is that of the cell plus (x_low, y_low, z_low). Masses are in the tree's unit.
struct CellMoments {
  float x_low, y_low, z_low;
  float mass;
  float xx, yy, zz, xy, xz, yz; ///< traceless quadrupole Σ m (3 d dᵀ − d² 1) about the centre, m²
};

class CellTree {
public:
  static constexpr std::uint32_t leaf_size = 8;
  static constexpr int deepest = 128;

  /// Cells of more than leaf_size particles are split in the middle of the longest side of their box, unless all stand
  /// at one place (as floats) or the tree would become deeper than `deepest`. Particle k has the id ids[places[k]]; in
  /// what order they come does not matter, but it is fast when neighbours follow each other.
  void build(std::span<const PointSource> particles, std::span<const std::uint32_t> places,
             std::span<const std::uint64_t> ids);

  /// The particles in the tree's order, and the place of each of them (its index in ids).
  const std::vector<PointSource>& particles() const { return particles_; }
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// The particles for kernels in single precision, masses in the tree's unit.
  const std::vector<SinglePoint>& points() const { return points_; }

  /// The largest mass, kg; 1 where all are zero.
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

} // namespace keeler
