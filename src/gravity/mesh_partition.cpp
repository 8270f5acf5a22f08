#include "mesh_partition.hpp"

#include "sheared_transform.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace keeler::gravity {
namespace {

// Returns the first slab of each rank, then the number of slabs. Half the weight of a slab is its fraction of all
// particles, half its fraction of all slabs: neither sparse columns nor dense ones fill a rank's memory.
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

// Returns the column of tiles at a distance (m) from the box's left edge. Columns beyond the edges continue the count.
std::int64_t column_at(double distance, double size, double width, std::int64_t columns) {
  const double boxes = std::floor(distance / size);
  const auto column = static_cast<std::int64_t>(std::max(0.0, (distance - boxes * size) / width));
  return static_cast<std::int64_t>(boxes) * columns + std::min(column, columns - 1);
}

// Returns the columns of tiles that a part needs: all that the search for neighbours (near_forces.cpp) can visit, with
// any rounding.
TileColumns needed_columns(const MeshPart& part, const Tiling& tiling, double size, double reach) {
  const double width = size * static_cast<double>(tiling.side) / static_cast<double>(tiling.columns);
  const auto columns = static_cast<std::int64_t>(tiling.tile_columns());
  auto first = static_cast<std::int64_t>(part.spread.begin), last = static_cast<std::int64_t>(part.spread.end) - 1;
  if (reach > 0.0) {
    const double far = reach + 1e-6 * width + edge_tolerance * size;
    const double begin = static_cast<double>(part.assigned.begin) * width;
    const double end = std::min(static_cast<double>(part.assigned.end) * width, size);
    first = std::min(first, column_at(begin - far, size, width, columns));
    last = std::max(last, column_at(end + far, size, width, columns));
  }
  if (last - first + 1 >= columns)
    return {0, tiling.tile_columns()};
  return {static_cast<std::size_t>((first + columns) % columns), static_cast<std::size_t>(last - first + 1)};
}

// Returns true if the non-empty ranges follow each other from 0 to `count`.
[[maybe_unused]] bool covers(std::span<const MeshPart> parts, IndexRange MeshPart::*range, std::size_t count) {
  std::size_t next = 0;
  for (const MeshPart& part : parts)
    if ((part.*range).size() > 0) {
      if ((part.*range).begin != next)
        return false;
      next = (part.*range).end;
    }
  return next == count;
}

// Returns the parts from left to right, by the number of all ranks' particles in each column of tiles.
std::vector<MeshPart> make_parts(const MeshShape& shape, const Tiling& tiling, const ShearingBox& box, double reach,
                                 std::span<const std::uint64_t> particles, std::size_t ranks) {
  assert(particles.size() == tiling.tile_columns());
  const std::size_t slab = Mesh::slab(tiling), waves = ShearedTransform::waves(shape);
  const std::vector<std::size_t> first = first_slabs(particles, slab, ranks);
  std::vector<MeshPart> parts(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    MeshPart& part = parts[r];
    part.waves = {waves * r / ranks, waves * (r + 1) / ranks};
    if (first[r] == first[r + 1])
      continue;
    part.assigned = {first[r] * slab, std::min(first[r + 1] * slab, tiling.tile_columns())};
    part.spread = {part.assigned.begin - (first[r] > 0 ? slab : 0), part.assigned.end};
    part.needed = needed_columns(part, tiling, box.size_x, reach);
    part.interpolated = {part.assigned.begin * tiling.side,
                         std::min(part.assigned.end * tiling.side, shape.columns) + MeshShape::ghosts};
    part.stored = {part.spread.begin * tiling.side, part.interpolated.end};
  }
  assert(covers(parts, &MeshPart::assigned, tiling.tile_columns()) && covers(parts, &MeshPart::waves, waves));
  return parts;
}

// Rotates the parts over the ranks so that most particles stay on their owner: the mesh's origin may move
// against the owners' slabs. Collective.
void rotate_to_owners(std::vector<MeshPart>& parts, std::span<const std::uint64_t> own, const Communicator& ranks) {
  std::vector<std::uint64_t> stay(parts.size(), 0); // particles, per rotation
  for (std::size_t rotation = 0; rotation < stay.size(); ++rotation) {
    const IndexRange& assigned = parts[(ranks.rank() + rotation) % parts.size()].assigned;
    const auto counts = own.subspan(assigned.begin, assigned.size());
    stay[rotation] = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  }
  ranks.sum(std::span(stay));
  std::rotate(parts.begin(), parts.begin() + (std::max_element(stay.begin(), stay.end()) - stay.begin()), parts.end());
}

} // namespace

MeshPartition::MeshPartition(const MeshShape& shape, const Tiling& tiling, const ShearingBox& box, double reach,
                             std::span<const std::uint64_t> particles_per_column, const Communicator& ranks)
    : rank_(ranks.rank()), ranks_needing_column_(tiling.tile_columns()) {
  std::vector<std::uint64_t> all(particles_per_column.begin(), particles_per_column.end());
  ranks.sum(std::span(all));
  parts_ = make_parts(shape, tiling, box, reach, all, ranks.size());
  rotate_to_owners(parts_, particles_per_column, ranks);
  for (std::size_t r = 0; r < parts_.size(); ++r)
    for (std::size_t k = 0; k < parts_[r].needed.count; ++k)
      ranks_needing_column_[(parts_[r].needed.begin + k) % ranks_needing_column_.size()].push_back(
          static_cast<std::uint32_t>(r));
}

} // namespace keeler::gravity
