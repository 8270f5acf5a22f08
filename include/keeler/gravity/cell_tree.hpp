// A tree of cells over particles, each cell with its mass, centre of mass and quadrupole.
//
// Invariants: the cells stand in preorder (a cell, its first child's subtree, its second child's subtree), so `span`
// skips a subtree; a cell's particles are one contiguous range, split between its two children; its box is tight. Which
// particles share a cell depends on their positions alone, and within a leaf they stand by id: sums over a tree never
// depend on the memory order the particles came in.
#pragma once

#include <keeler/core/vector.hpp>

#include <cstdint>
#include <vector>

namespace keeler {

/// A particle inside the tree, and where it stood in the caller's arrays.
struct TreeParticle {
  double x, y, z;
  double mass;
  std::uint64_t id;
  std::size_t index;
};

struct TreeCell {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero(); ///< tight bounding box
  Vec3 centre = Vec3::Zero();                   ///< of mass
  double mass = 0.0;                            ///< kg
  Vec3 diagonal = Vec3::Zero(); ///< Q_xx, Q_yy, Q_zz of the traceless quadrupole about the centre, kg m²
  Vec3 mixed = Vec3::Zero();    ///< Q_xy, Q_xz, Q_yz
  double size = 0.0;            ///< longest side of the box, m
  std::uint32_t begin = 0;      ///< first particle
  std::uint32_t count = 0;      ///< particles
  std::uint32_t span = 1;       ///< cells of this subtree, itself included; 1 for a leaf

  bool is_leaf() const { return span == 1; }
};

class CellTree {
public:
  static constexpr std::size_t leaf_size = 16;
  static constexpr int deepest = 128;

  /// Takes the particles in any order. Cells of more than leaf_size particles are split in the middle of the longest
  /// side of their box, unless all stand at one place or the tree would become deeper than `deepest`.
  void build(std::vector<TreeParticle> particles);

  const std::vector<TreeParticle>& particles() const { return particles_; }
  const std::vector<TreeCell>& cells() const { return cells_; }

private:
  std::vector<TreeParticle> particles_;
  std::vector<TreeCell> cells_;
};

} // namespace keeler
