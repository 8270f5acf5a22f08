// From the cells of lines to neighbour lists, and from these to pairs, each once.
#pragma once

#include "line_cells.hpp"
#include "marked_set.hpp"
#include "verlet_list.hpp"

#include <vector>

namespace keeler::collision {

using PaddedPairs = std::vector<LinePair>; ///< kernel_padding more than it holds, or empty

inline std::size_t pair_count(const PaddedPairs& pairs) {
  assert(pairs.size() >= kernel_padding);
  return pairs.size() - kernel_padding;
}

/// Returns the pairs (i, j) with i in `particles` and j on the list of i; if j is marked too, only from the smaller
/// index. So each pair occurs once when all blocks of the marked particles are visited.
PaddedPairs pairs_of_lists(const VerletList& list, std::span<const std::uint32_t> particles, const MarkedSet& marked);

/// Number of marked particles in a block; the whole lists of a block are visited together.
inline constexpr std::size_t marked_block = 64;
inline std::size_t marked_blocks(const MarkedSet& marked) {
  return (marked.size() + marked_block - 1) / marked_block;
}
inline std::span<const std::uint32_t> marked_members(const MarkedSet& marked, std::size_t block) {
  assert(block < marked_blocks(marked));
  const std::size_t begin = block * marked_block;
  return marked.members().subspan(begin, std::min(marked_block, marked.size() - begin));
}

/// What rebuild_lists() has done.
struct ListRebuild {
  std::uint64_t tested = 0; ///< pairs of lines
  std::uint64_t entries = 0;
};
/// Finds all pairs of lines that may touch within `half` (rad) before and after their instant, and lays out and fills
/// the lists with them.
ListRebuild rebuild_lists(const LineCells& cells, double half, VerletList& list);

} // namespace keeler::collision
