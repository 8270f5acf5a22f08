#include <keeler/core/large_blocks.hpp>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <iterator>
#include <limits>
#include <utility>

#include <sys/mman.h>
#include <unistd.h>

namespace keeler {
namespace {

std::size_t whole_pages(std::size_t bytes) {
  return (bytes + LargeBlocks::page - 1) / LargeBlocks::page * LargeBlocks::page;
}

bool is_shorter(const std::pair<std::byte* const, std::size_t>& a, const std::pair<std::byte* const, std::size_t>& b) {
  return a.second < b.second;
}

std::atomic<bool> are_reused = false;

} // namespace

LargeBlocks::~LargeBlocks() {
  for (const Ranges* ranges : {&taken_, &free_})
    for (const auto& [begin, bytes] : *ranges)
      munmap(begin, bytes);
}

void* LargeBlocks::take(std::size_t bytes) {
  assert(bytes > 0);
  if (bytes > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max()))
    return nullptr;
  bytes = whole_pages(bytes);
  Ranges row; // made first: afterwards nothing needs memory
  try {
    row.emplace(nullptr, bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  std::byte* const block = find(bytes);
  if (!block)
    return nullptr;
  auto taken = row.extract(row.begin());
  taken.key() = block;
  taken_.insert(std::move(taken));
  used_ += bytes;
  most_used_ = std::max(most_used_, used_);
  keep_at_most(most_used_ - used_);
  assert(used_ + kept_ <= most_used_);
  return block;
}

std::byte* LargeBlocks::find(std::size_t bytes) {
  auto shortest = free_.end(); // of the ranges that are long enough, so that longer ones stay whole
  for (auto range = free_.begin(); range != free_.end(); ++range)
    if (range->second >= bytes && (shortest == free_.end() || range->second < shortest->second))
      shortest = range;
  if (shortest != free_.end())
    return cut_from(shortest, bytes);
  if (std::byte* const block = extend_longest(bytes))
    return block;
  keep_at_most(0);
  return fetch(bytes);
}

bool LargeBlocks::give_back(void* block) {
  const auto taken = taken_.find(static_cast<std::byte*>(block));
  if (taken == taken_.end())
    return false;
  used_ -= taken->second;
  keep(taken_.extract(taken));
  assert(used_ + kept_ <= most_used_);
  return true;
}

std::byte* LargeBlocks::cut_from(Ranges::iterator range, std::size_t bytes) {
  auto rest = free_.extract(range);
  std::byte* const begin = rest.key();
  rest.key() += bytes;
  rest.mapped() -= bytes;
  if (rest.mapped() > 0)
    free_.insert(std::move(rest));
  kept_ -= bytes;
  return begin;
}

std::byte* LargeBlocks::fetch(std::size_t bytes) {
  void* const block = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (block == MAP_FAILED)
    return nullptr;
  fetched_ += bytes;
  return static_cast<std::byte*>(block);
}

// Extends the longest free range, which is too short; its pages move to another address if need be.
std::byte* LargeBlocks::extend_longest(std::size_t bytes) {
  const auto longest = std::max_element(free_.begin(), free_.end(), is_shorter);
  if (longest == free_.end())
    return fetch(bytes);
  const auto [begin, had] = *longest;
  assert(had < bytes);
  void* const block = mremap(begin, had, bytes, MREMAP_MAYMOVE);
  if (block == MAP_FAILED) // for example, the range has pages of two mappings
    return fetch(bytes);
  free_.erase(longest);
  kept_ -= had;
  fetched_ += bytes - had;
  return static_cast<std::byte*>(block);
}

// Allocates nothing, so that freeing works when memory is exhausted.
void LargeBlocks::keep(Ranges::node_type block) {
  kept_ += block.mapped();
  const auto range = free_.insert(std::move(block)).position;
  if (const auto next = std::next(range); next != free_.end() && range->first + range->second == next->first) {
    range->second += next->second;
    free_.erase(next);
  }
  if (range == free_.begin())
    return;
  if (const auto previous = std::prev(range); previous->first + previous->second == range->first) {
    previous->second += range->second;
    free_.erase(range);
  }
}

// Returns what is kept beyond this to the system, the shortest ranges first.
void LargeBlocks::keep_at_most(std::size_t bytes) {
  while (kept_ > bytes) {
    const auto range = std::min_element(free_.begin(), free_.end(), is_shorter);
    const std::size_t excess = std::min(range->second, kept_ - bytes);
    range->second -= excess;
    kept_ -= excess;
    munmap(range->first + range->second, excess);
    if (range->second == 0)
      free_.erase(range);
  }
}

void reuse_large_blocks() {
  const bool has_such_pages = sysconf(_SC_PAGESIZE) == static_cast<long>(LargeBlocks::page);
  are_reused.store(has_such_pages, std::memory_order_relaxed);
}

bool large_blocks_are_reused() {
  return are_reused.load(std::memory_order_relaxed);
}

} // namespace keeler
