// The pairs of the neighbour lists, each once: the pairs found when all lists were rebuilt; but particles with a list
// rebuilt by itself since then contribute their whole lists instead.
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

class ListedPairs {
public:
  /// What rebuild() has done.
  struct Rebuild {
    std::uint64_t tested = 0; ///< pairs of lines
    std::uint64_t entries = 0;
  };
  /// Finds all pairs of lines that may touch within `half` (rad) before and after their instant, and lays out and fills
  /// the lists with them.
  Rebuild rebuild(const LineCells& cells, double half, VerletList& list);

  /// Notes that the list of particle i has been rebuilt by itself.
  void renewed(std::size_t i) { renewed_.insert(i); }

  /// Calls visit(pairs) for the pairs of a block. Pairs of a block from_rebuild() may be superseded(), since the list
  /// of one of their particles was rebuilt by itself. Blocks may be visited by several threads.
  template<class Visit> void visit_block(std::size_t block, const VerletList& list, const Visit& visit) const {
    if (from_rebuild(block))
      visit(found_[block]);
    else
      visit(pairs_of_lists(list, marked_members(renewed_, block - found_.size()), renewed_));
  }
  std::size_t blocks() const { return found_.size() + marked_blocks(renewed_); }
  bool from_rebuild(std::size_t block) const { return block < found_.size(); }
  bool superseded(const LinePair& pair) const {
    return renewed_.contains(pair.first) || renewed_.contains(pair.second);
  }

  void release() { found_ = {}; }
  std::size_t bytes() const;
  /// True if each pair of the lists, which must be sound, is there once.
  bool sound(const VerletList& list) const;

private:
  struct Parts;
  std::uint64_t find(const LineCells& cells, double half, Parts& parts);
  void fill(const LineCells& cells, const Parts& parts, VerletList& list);

  std::vector<PaddedPairs> found_; // by block of slots
  MarkedSet renewed_;
};

} // namespace keeler::collision
