#include <keeler/core/large_blocks.hpp>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <iterator>
#include <tuple>
#include <utility>

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace keeler {
namespace {

std::size_t up_to_multiple(std::size_t number, std::size_t of) {
  return (number + of - 1) / of * of;
}

std::atomic<bool> are_reused = false;

} // namespace

LargeBlocks::LargeBlocks(std::size_t bytes) {
  const std::size_t count = (bytes + unit - 1) / unit, mapped = (count + 1) * unit;
  // no memory yet, and none set aside; one unit more, since the first one begins at a multiple of its size
  void* const range = mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (range == MAP_FAILED)
    return;
  try {
    free_.emplace(0, count * pages_in_unit);
    units_.resize(count);
  } catch (const std::bad_alloc&) {
    free_.clear();
    munmap(range, mapped);
    return;
  }
  mapping_ = range;
  mapped_ = mapped;
  const auto address = reinterpret_cast<std::uintptr_t>(range);
  begin_ = static_cast<std::byte*>(range) + (up_to_multiple(address, unit) - address);
  madvise(begin_, count * unit, MADV_HUGEPAGE); // where there are none, a unit gets its pages one by one
}

LargeBlocks::~LargeBlocks() {
  if (mapping_)
    munmap(mapping_, mapped_);
}

void* LargeBlocks::take(std::size_t bytes) {
  assert(bytes > 0);
  if (bytes > units_.size() * unit)
    return nullptr;
  const std::size_t pages = (bytes + page - 1) / page;
  const auto range = best_range(pages);
  if (range == free_.end())
    return nullptr;
  Ranges row; // made first: afterwards nothing needs memory
  try {
    row.emplace(range->first, pages);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  auto taken = row.extract(row.begin());
  const std::size_t begin = taken.key();
  cut_from(range, pages);
  taken_.insert(std::move(taken));
  for_units(begin, pages, [this](Unit& some, std::size_t pages_there) {
    if (!std::exchange(some.has_memory, true)) {
      ++held_;
      fetched_ += unit;
    } else if (some.used == 0) {
      --empty_;
    }
    some.used = static_cast<std::uint16_t>(some.used + pages_there);
  });
  end_ = std::max(end_, (begin + pages - 1) / pages_in_unit + 1);
  used_ += pages * page;
  most_used_ = std::max(most_used_, used_);
  release_excess();
  return begin_ + begin * page;
}

bool LargeBlocks::give_back(void* block) {
  const auto address = reinterpret_cast<std::uintptr_t>(block), first = reinterpret_cast<std::uintptr_t>(begin_);
  const auto taken = address < first ? taken_.end() : taken_.find((address - first) / page);
  if (taken == taken_.end() || (address - first) % page != 0)
    return false;
  for_units(taken->first, taken->second, [this](Unit& some, std::size_t pages_there) {
    assert(some.has_memory && some.used >= pages_there);
    some.used = static_cast<std::uint16_t>(some.used - pages_there);
    empty_ += some.used == 0;
  });
  used_ -= taken->second * page;
  keep(taken_.extract(taken));
  release_excess();
  return true;
}

// Returns the free range at whose begin a block needs the fewest new units, and the shortest one if there are several,
// so that longer ones stay whole.
LargeBlocks::Ranges::iterator LargeBlocks::best_range(std::size_t pages) {
  auto best = free_.end();
  std::tuple<std::size_t, std::size_t> least;
  for (auto range = free_.begin(); range != free_.end(); ++range)
    if (range->second >= pages)
      if (const std::tuple cost(missing_units(range->first, pages), range->second);
          best == free_.end() || cost < least) {
        best = range;
        least = cost;
      }
  return best;
}

std::size_t LargeBlocks::missing_units(std::size_t begin, std::size_t pages) const {
  const auto first = units_.begin() + static_cast<std::ptrdiff_t>(begin / pages_in_unit);
  const auto end = units_.begin() + static_cast<std::ptrdiff_t>((begin + pages - 1) / pages_in_unit + 1);
  return static_cast<std::size_t>(std::count_if(first, end, [](const Unit& some) { return !some.has_memory; }));
}

// Calls act(unit, pages) for each unit of a range, with the number of pages of the range in it.
template<class Do> void LargeBlocks::for_units(std::size_t begin, std::size_t pages, const Do& act) {
  for (std::size_t at = begin; at < begin + pages;) {
    const std::size_t end = std::min(begin + pages, (at / pages_in_unit + 1) * pages_in_unit);
    act(units_[at / pages_in_unit], end - at);
    at = end;
  }
}

void LargeBlocks::cut_from(Ranges::iterator range, std::size_t pages) {
  auto rest = free_.extract(range);
  rest.key() += pages;
  rest.mapped() -= pages;
  if (rest.mapped() > 0)
    free_.insert(std::move(rest));
}

// Allocates nothing, so that freeing works when memory is exhausted.
void LargeBlocks::keep(Ranges::node_type block) {
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

// Returns units without blocks to the system, the last ones first, until no more than most_used() is held.
void LargeBlocks::release_excess() {
  for (std::size_t k = end_; k-- > 0 && empty_ > 0 && held() > most_used_;) {
    Unit& some = units_[k];
    if (some.has_memory && some.used == 0) {
      madvise(begin_ + k * unit, unit, MADV_DONTNEED);
      some.has_memory = false;
      --held_;
      --empty_;
    }
  }
  while (end_ > 0 && !units_[end_ - 1].has_memory)
    --end_;
}

void reuse_large_blocks() {
  rlimit limit{};
  const bool is_limited = getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
  const bool has_such_pages = sysconf(_SC_PAGESIZE) == static_cast<long>(LargeBlocks::page);
  are_reused.store(has_such_pages && !is_limited, std::memory_order_relaxed);
}

void stop_reusing_large_blocks() {
  are_reused.store(false, std::memory_order_relaxed);
}

bool large_blocks_are_reused() {
  return are_reused.load(std::memory_order_relaxed);
}

} // namespace keeler
