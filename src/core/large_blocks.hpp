// Large blocks of memory that are used again: what one array leaves serves the next ones, whatever their sizes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <new>
#include <utility>
#include <vector>

namespace keeler {

/// The C library's memory, for what operator new itself needs.
template<class T> struct CAllocator {
  using value_type = T;

  CAllocator() = default;
  template<class U> CAllocator(const CAllocator<U>&) {} // NOLINT(google-explicit-constructor): an allocator converts

  T* allocate(std::size_t count) {
    if (void* const place = std::malloc(count * sizeof(T)))
      return static_cast<T*>(place);
    throw std::bad_alloc();
  }
  void deallocate(T* place, std::size_t) { std::free(place); }
  friend bool operator==(const CAllocator&, const CAllocator&) { return true; }
};

/// Blocks of whole pages in one range of addresses, which has memory by *units* of the size of a huge page: a unit has
/// memory from the first block in it until it is released. A unit without blocks is kept as long as all units with
/// memory are not more than was once used. Not for several threads at once.
/// Invariants: free ranges do not touch each other; a unit with a block has memory.
class LargeBlocks {
public:
  static constexpr std::size_t page = std::size_t{1} << 12, unit = std::size_t{1} << 21; // bytes

  /// Takes a range of so many bytes of addresses, in whole units; none if the system refuses that.
  explicit LargeBlocks(std::size_t bytes);
  LargeBlocks(const LargeBlocks&) = delete;
  LargeBlocks& operator=(const LargeBlocks&) = delete;
  ~LargeBlocks(); ///< Returns all to the system, blocks that are taken too.

  /// Returns a block of `bytes` > 0 that begins a page; null if no free range is that long, or its place cannot be
  /// noted.
  void* take(std::size_t bytes);

  /// Returns false, and does nothing, if `block` was not taken from here.
  bool give_back(void* block);

  std::size_t used() const { return used_; }           ///< bytes of blocks that are taken, in whole pages
  std::size_t held() const { return held_ * unit; }    ///< bytes of the units with memory
  std::size_t most_used() const { return most_used_; } ///< the maximum of used() so far
  std::uint64_t fetched() const { return fetched_; }   ///< bytes that the system gave, in all

private:
  using Ranges = std::map<std::size_t, std::size_t, std::less<>,
                          CAllocator<std::pair<const std::size_t, std::size_t>>>; // pages of each range, by its first
  struct Unit {
    std::uint16_t used = 0; // pages
    bool has_memory = false;
  };
  static constexpr std::size_t pages_in_unit = unit / page;

  Ranges::iterator best_range(std::size_t pages);
  std::size_t missing_units(std::size_t begin, std::size_t pages) const;
  template<class Do> void for_units(std::size_t begin, std::size_t pages, const Do& act);
  void cut_from(Ranges::iterator range, std::size_t pages);
  void keep(Ranges::node_type block);
  void release_excess();

  void* mapping_ = nullptr;
  std::size_t mapped_ = 0;
  std::byte* begin_ = nullptr; // of the first unit
  std::vector<Unit, CAllocator<Unit>> units_;
  Ranges taken_, free_;
  std::size_t used_ = 0, most_used_ = 0; // bytes
  std::size_t held_ = 0, empty_ = 0;     // units with memory, and how many of them have no blocks
  std::size_t end_ = 0;                  // of the units with memory
  std::uint64_t fetched_ = 0;
};

/// Makes the operator new of a program that has one (cli/allocation.cpp: without sanitizers) use large blocks again
/// from now on, but for systems with other pages and where addresses are limited (ulimit -v).
void reuse_large_blocks();

/// From now on it asks the C library for all blocks, so that a limit on addresses is one on memory.
void stop_reusing_large_blocks();

bool large_blocks_are_reused();

} // namespace keeler
