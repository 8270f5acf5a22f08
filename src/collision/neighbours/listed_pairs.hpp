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

/// Returns the pairs (i, j) with i in `particles` and j on the list of i; if is_visited(j), so that the list of j is
/// gone through too, only from the smaller index. So each pair occurs once when all lists to be visited are.
template<class IsVisited>
PaddedPairs pairs_of_lists(const VerletList& list, const auto& particles, const IsVisited& is_visited) {
  std::size_t room = kernel_padding, count = 0;
  for (const std::uint32_t i : particles)
    room += list.length(i);
  PaddedPairs pairs(room);
  for (const std::uint32_t i : particles) {
    assert(is_visited(i));
    for (const std::uint32_t j : list.list(i)) {
      pairs[count] = {i, j};
      count += !is_visited(j) || i < j;
    }
  }
  pairs.resize(count + kernel_padding);
  return pairs;
}

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
