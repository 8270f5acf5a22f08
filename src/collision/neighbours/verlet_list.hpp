// The neighbour lists of all particles (Verlet 1967) in one array, with room behind each list for more entries.
//
// Invariants: entries are symmetric, j on the list of i and i on the list of j, each once, i not on its own; no list
// reaches into the room of another.
#pragma once

#include "kernels.hpp"

#include <keeler/core/memory.hpp>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::collision {

class VerletList {
public:
  /// Lays out empty lists one behind the other: the k-th belongs to particle(k), and will get lengths[k] entries.
  /// Throws InvariantError if they are too many. Precondition: particle is a permutation of [0, lengths.size()).
  template<class Particle> void lay_out(std::span<const std::uint32_t> lengths, const Particle& particle);

  /// Appends an entry to the list of i; the caller makes it symmetric. Several threads may call it for different i.
  /// Precondition: lay_out() made room for it.
  void put(std::uint32_t i, std::uint32_t entry) {
    Range& range = ranges_[i];
    assert(range.count < range.room);
    entries_[range.begin + range.count++] = entry;
  }

  /// Replaces the list of i and keeps the lists symmetric. `found` may contain i itself, which is skipped.
  void replace(std::uint32_t i, std::span<const std::uint32_t> found);

  std::size_t size() const { return ranges_.size(); } ///< particles
  std::uint32_t length(std::size_t i) const { return ranges_[i].count; }
  std::span<const std::uint32_t> list(std::size_t i) const {
    return {entries_.data() + ranges_[i].begin, ranges_[i].count};
  }

  /// True if replaced lists have left so many holes that a new layout is better.
  bool outgrown() const { return entries_.size() > 2 * entries_laid_out_ + 4096; }

  /// Frees the entries. Precondition: of the other calls only lay_out() and size() follow.
  void release() { free_memory(entries_); }
  std::size_t bytes() const { return ranges_.capacity() * sizeof(Range) + entries_.capacity() * sizeof(std::uint32_t); }

  /// True if the invariants hold. Slow.
  bool sound() const;

private:
  /// Location of a list in entries_.
  struct Range {
    std::uint32_t begin = 0, count = 0, room = 0;
  };
  void check_length(std::uint64_t entries) const;
  void erase(std::uint32_t i, std::uint32_t entry);
  void append(std::uint32_t i, std::uint32_t entry);
  void move_to_end(Range& range, std::uint32_t room);

  std::vector<Range> ranges_;
  std::vector<std::uint32_t> entries_; // with kernel_padding behind
  std::size_t entries_laid_out_ = 0;
};

template<class Particle> void VerletList::lay_out(std::span<const std::uint32_t> lengths, const Particle& particle) {
  ranges_.resize(lengths.size());
  std::uint64_t begin = 0;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    const std::uint32_t room = lengths[k] + lengths[k] / 4 + 2;
    assert(particle(k) < lengths.size());
    ranges_[particle(k)] = {static_cast<std::uint32_t>(begin), 0, room};
    begin += room;
  }
  check_length(begin);
  entries_laid_out_ = begin;
  entries_.assign(begin + kernel_padding, 0);
}

} // namespace keeler::collision
