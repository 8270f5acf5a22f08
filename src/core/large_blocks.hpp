// Large blocks of memory that are used again: pages that one array leaves serve the next ones, whatever their sizes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <new>
#include <utility>

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

/// Blocks of whole pages from the system. Pages of blocks that are given back are kept as long as used() + kept() does
/// not exceed most_used(). Not for several threads at once.
/// Invariants: used() + kept() <= most_used(); no two free ranges follow each other without a gap.
class LargeBlocks {
public:
  static constexpr std::size_t page = 4096; // bytes

  LargeBlocks() = default;
  LargeBlocks(const LargeBlocks&) = delete;
  LargeBlocks& operator=(const LargeBlocks&) = delete;
  ~LargeBlocks(); ///< Returns all to the system, blocks that are taken too.

  /// Returns a block of `bytes` > 0 that begins a page; null if the system has no memory for it, even without what is
  /// kept here.
  void* take(std::size_t bytes);

  /// Returns false, and does nothing, if `block` was not taken from here.
  bool give_back(void* block);

  std::size_t used() const { return used_; }           ///< bytes of blocks that are taken, in whole pages
  std::size_t kept() const { return kept_; }           ///< bytes that are free for the next blocks
  std::size_t most_used() const { return most_used_; } ///< the maximum of used() so far
  std::uint64_t fetched() const { return fetched_; }   ///< bytes that the system gave, in all

private:
  // the bytes of each range, by its begin
  using Ranges = std::map<std::byte*, std::size_t, std::less<>, CAllocator<std::pair<std::byte* const, std::size_t>>>;

  std::byte* find(std::size_t bytes);
  std::byte* cut_from(Ranges::iterator range, std::size_t bytes);
  std::byte* fetch(std::size_t bytes);
  std::byte* extend_longest(std::size_t bytes);
  void keep(Ranges::node_type block);
  void keep_at_most(std::size_t bytes);

  Ranges taken_, free_;
  std::size_t used_ = 0, kept_ = 0, most_used_ = 0;
  std::uint64_t fetched_ = 0;
};

/// Makes the operator new of a program that has one (cli/allocation.cpp: with KEELER_MPI, without sanitizers) use large
/// blocks again from now on. Does nothing on a system with other pages.
void reuse_large_blocks();

bool large_blocks_are_reused();

} // namespace keeler
