// Partition of the mesh over ranks. A rank is assigned whole columns of tiles, in units of the slabs of Mesh::spread()
// counted from column 0, and computes the accelerations of the particles in them. Between the transforms along y and x
// it holds a range of waves instead.
//
// Invariants: each column of tiles is assigned to exactly one rank, and so is each wave. No sum is split: a rank has
// all particles that spread into its nodes, and all neighbours of its particles. For this it needs particles in whole
// columns of tiles around its own, in the order that they have on every rank, so all sums have the bits of one process.
#pragma once

#include "index_range.hpp"
#include "mesh.hpp"
#include "sorted_particles.hpp"

#include <keeler/comm/communicator.hpp>
#include <keeler/hill/shearing_box.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace keeler::gravity {

/// The part of the mesh that one rank is assigned. A rank without columns may still have waves.
struct MeshPart {
  IndexRange assigned;     ///< columns of tiles
  IndexRange spread;       ///< columns of tiles with particles that spread into its nodes: assigned, and the slab below
  TileColumns needed;      ///< columns of tiles with particles that it needs: spread, and neighbours of assigned ones
  IndexRange interpolated; ///< columns of nodes at its particles: assigned, and three ghost columns of the next part
  IndexRange stored;       ///< columns of nodes that its mesh holds
  IndexRange waves;        ///< along y
};

/// Positions inside the cell may exceed its bounds by this fraction of the box: rounding.
inline constexpr double edge_tolerance = 1e-9;

class MeshPartition {
public:
  /// Partitions the mesh by the number of this rank's particles per column of tiles. No rank is assigned more than
  /// twice the mean number of particles or of columns, plus one slab. Most particles stay on their owner.
  /// `reach` is the largest distance of neighbours, m; 0: there are none. Collective.
  MeshPartition(const MeshShape& shape, const Tiling& tiling, const ShearingBox& box, double reach,
                std::span<const std::uint64_t> particles_per_column, const Communicator& ranks);

  /// The part of each rank, and that of this one.
  std::span<const MeshPart> parts() const { return parts_; }
  const MeshPart& own() const { return parts_[rank_]; }

  /// Returns the ranks that need the particles of a column of tiles, ascending; one of them is assigned the column.
  std::span<const std::uint32_t> ranks_needing_column(std::size_t column) const {
    return ranks_needing_column_[column];
  }

private:
  std::size_t rank_;
  std::vector<MeshPart> parts_;
  std::vector<std::vector<std::uint32_t>> ranks_needing_column_;
};

} // namespace keeler::gravity
