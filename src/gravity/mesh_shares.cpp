#include "mesh_shares.hpp"

#include "sheared_transform.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keeler {
namespace {

// The first slab of each rank, and behind them the end of the last. A slab counts half by its particles, half as one of
// all slabs: neither sparse columns nor dense ones fill a rank's memory.
std::vector<std::size_t> first_slabs(std::span<const std::uint64_t> particles, std::size_t width, std::size_t ranks) {
  const std::uint64_t all = std::accumulate(particles.begin(), particles.end(), std::uint64_t{0});
  const std::size_t slabs = (particles.size() + width - 1) / width;
  std::vector<std::size_t> first{0};
  double weight = 0.0; // of 2 all
  for (std::size_t s = 0; s < slabs; ++s) {
    while (first.size() < ranks &&
           weight * static_cast<double>(ranks) >= 2.0 * static_cast<double>(all) * static_cast<double>(first.size()))
      first.push_back(s);
    for (std::size_t a = s * width; a < std::min((s + 1) * width, particles.size()); ++a)
      weight += static_cast<double>(particles[a]);
    weight += static_cast<double>(all) / static_cast<double>(slabs);
  }
  first.resize(ranks + 1, slabs);
  return first;
}

// The column of tiles so far (m) from the box's left edge; columns are counted on beyond both edges.
std::int64_t column_at(double place, double size, double width, std::int64_t columns) {
  const double boxes = std::floor(place / size);
  const auto column = static_cast<std::int64_t>(std::max(0.0, (place - boxes * size) / width));
  return static_cast<std::int64_t>(boxes) * columns + std::min(column, columns - 1);
}

// With all that neighbours' windows touch (near_forces.cpp), whichever way they are rounded.
TileColumns known_columns(const MeshShare& share, const Tiling& tiling, double size, double reach) {
  const double width = size * static_cast<double>(tiling.side) / static_cast<double>(tiling.columns);
  const auto columns = static_cast<std::int64_t>(tiling.tile_columns());
  auto first = static_cast<std::int64_t>(share.spread.begin), last = static_cast<std::int64_t>(share.spread.end) - 1;
  if (reach > 0.0) {
    const double far = reach + 1e-6 * width + loose_edge * size;
    const double begin = static_cast<double>(share.own.begin) * width;
    const double end = std::min(static_cast<double>(share.own.end) * width, size);
    first = std::min(first, column_at(begin - far, size, width, columns));
    last = std::max(last, column_at(end + far, size, width, columns));
  }
  if (last - first + 1 >= columns)
    return {0, tiling.tile_columns()};
  return {static_cast<std::size_t>((first + columns) % columns), static_cast<std::size_t>(last - first + 1)};
}

} // namespace

std::vector<MeshShare> share_mesh(const MeshShape& shape, const Tiling& tiling, const ShearingBox& box, double reach,
                                  std::span<const std::uint64_t> particles, std::size_t ranks) {
  const std::size_t slab = Mesh::slab(tiling), waves = ShearedTransform::waves(shape);
  const std::vector<std::size_t> first = first_slabs(particles, slab, ranks);
  std::vector<MeshShare> shares(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    MeshShare& share = shares[r];
    share.waves = {waves * r / ranks, waves * (r + 1) / ranks};
    if (first[r] == first[r + 1])
      continue;
    share.own = {first[r] * slab, std::min(first[r + 1] * slab, tiling.tile_columns())};
    share.spread = {share.own.begin - (first[r] > 0 ? slab : 0), share.own.end};
    share.known = known_columns(share, tiling, box.size_x, reach);
    share.pulled = {share.own.begin * tiling.side,
                    std::min(share.own.end * tiling.side, shape.columns) + MeshShape::ghosts};
    share.stored = {share.spread.begin * tiling.side, share.pulled.end};
  }
  return shares;
}

std::vector<std::vector<std::uint32_t>> who_must_know(std::span<const MeshShare> shares, const Tiling& tiling) {
  std::vector<std::vector<std::uint32_t>> ranks(tiling.tile_columns());
  for (std::size_t r = 0; r < shares.size(); ++r)
    for (std::size_t k = 0; k < shares[r].known.count; ++k)
      ranks[(shares[r].known.begin + k) % ranks.size()].push_back(static_cast<std::uint32_t>(r));
  return ranks;
}

} // namespace keeler
