// How many ranks share one mesh. Each has a range of columns of tiles, whole slabs of Mesh::spread() counted from
// column 0, and with them the particles there; between the transforms along y and x it has a range of waves instead.
//
// No sum is made in two parts: who owns a column of nodes knows all particles that spread into it, and who owns a
// particle knows all its neighbours. For that a rank gets copies of the particles in whole columns of tiles round its
// own ones. In them the particles stand in the same order everywhere, so all sums have the bits of one process.
#pragma once

#include "index_range.hpp"
#include "mesh.hpp"
#include "places.hpp"

#include <keeler/hill/shearing_box.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace keeler {

/// What one rank has: nothing, but for waves, where its own columns are none.
struct MeshShare {
  IndexRange own;    ///< columns of tiles
  IndexRange spread; ///< those whose particles spread into own nodes: the own ones and the slab below
  TileColumns known; ///< those whose particles it must know: these and all that neighbours are in
  IndexRange pulled; ///< columns of nodes that its own particles feel: its own ones and three more, the next owner's
  IndexRange stored; ///< columns of nodes that its mesh must hold
  IndexRange waves;  ///< along y
};

/// Places inside the cell must be within it but for this much, of the box: rounding.
inline constexpr double loose_edge = 1e-9;

/// The shares of so many ranks, from the number of all particles in each column of tiles; none of them has more than
/// twice the mean of particles or of columns, but for a slab. Neighbours are up to `reach` away (m); 0: there are none.
std::vector<MeshShare> share_mesh(const MeshShape& shape, const Tiling& tiling, const ShearingBox& box, double reach,
                                  std::span<const std::uint64_t> particles, std::size_t ranks);

/// The ranks that must know the particles of each column of tiles.
std::vector<std::vector<std::uint32_t>> who_must_know(std::span<const MeshShare> shares, const Tiling& tiling);

} // namespace keeler
