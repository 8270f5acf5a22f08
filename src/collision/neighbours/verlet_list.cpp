#include "verlet_list.hpp"

#include <keeler/core/error.hpp>

#include <fmt/format.h>

#include <utility>

namespace keeler::collision {

void VerletList::check_length(std::uint64_t entries) const {
  if (entries > std::uint64_t{1} << 31)
    throw InvariantError(
        fmt::format("neighbour lists of {} entries are too long; take a shorter step or fewer particles", entries));
}

void VerletList::replace(std::uint32_t i, std::span<const std::uint32_t> found) {
  assert(i < ranges_.size());
  for (const std::uint32_t j : list(i))
    erase(j, i);
  ranges_[i].count = 0;
  if (ranges_[i].room < found.size())
    move_to_end(ranges_[i], static_cast<std::uint32_t>(found.size()));
  Range& range = ranges_[i];
  for (const std::uint32_t j : found)
    if (j != i) {
      entries_[range.begin + range.count++] = j;
      append(j, i);
    }
}

void VerletList::erase(std::uint32_t i, std::uint32_t entry) {
  Range& range = ranges_[i];
  std::uint32_t* const entries = entries_.data() + range.begin;
  std::uint32_t* const at = std::find(entries, entries + range.count, entry);
  assert(at < entries + range.count); // entries are symmetric
  *at = entries[--range.count];
}

void VerletList::append(std::uint32_t i, std::uint32_t entry) {
  Range& range = ranges_[i];
  if (range.count == range.room)
    move_to_end(range, range.count + 1);
  entries_[range.begin + range.count++] = entry;
}

// Gives a list room for that many entries, and for some more, behind all others.
void VerletList::move_to_end(Range& range, std::uint32_t room) {
  assert(room >= range.count && entries_.size() >= kernel_padding);
  const std::size_t begin = entries_.size() - kernel_padding;
  room += room / 4 + 2;
  entries_.resize(entries_.size() + room, 0);
  std::copy_n(entries_.begin() + range.begin, range.count, entries_.begin() + static_cast<std::ptrdiff_t>(begin));
  range.begin = static_cast<std::uint32_t>(begin);
  range.room = room;
}

bool VerletList::sound() const {
  std::vector<Range> in_order = ranges_;
  std::sort(in_order.begin(), in_order.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  std::size_t end = 0;
  for (const Range& range : in_order) {
    if (range.count > range.room || end > range.begin)
      return false;
    end = std::size_t{range.begin} + range.room;
  }
  if (end + kernel_padding > entries_.size())
    return false;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> forth, back;
  for (std::uint32_t i = 0; i < size(); ++i)
    for (const std::uint32_t j : list(i)) {
      if (j >= size() || j == i)
        return false;
      forth.emplace_back(i, j);
      back.emplace_back(j, i);
    }
  std::sort(forth.begin(), forth.end());
  std::sort(back.begin(), back.end());
  return forth == back && std::adjacent_find(forth.begin(), forth.end()) == forth.end();
}

} // namespace keeler::collision
