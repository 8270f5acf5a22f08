// The invariants of the neighbour lists, for builds with assertions.
#include "neighbour_lists.hpp"

#ifndef NDEBUG

#include <algorithm>
#include <cassert>
#include <utility>

namespace keeler {
namespace {

constexpr std::size_t max_checked = 20000; // particles: more take long

// Entries are mutual: each pair is there twice, once either way, and nobody is on its own list.
void assert_mutual(const NeighbourLists& lists, std::size_t count) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> forth, back;
  for (std::uint32_t i = 0; i < count; ++i)
    for (const std::uint32_t j : lists.list(i)) {
      assert(j < count && j != i);
      forth.emplace_back(i, j);
      back.emplace_back(j, i);
    }
  std::sort(forth.begin(), forth.end());
  std::sort(back.begin(), back.end());
  assert(forth == back);
  assert(std::adjacent_find(forth.begin(), forth.end()) == forth.end());
}

// Those named are those marked, once each.
void assert_marked(const std::vector<std::uint32_t>& which, const std::vector<std::uint8_t>& marks) {
  assert(std::all_of(which.begin(), which.end(), [&](std::uint32_t i) { return i < marks.size() && marks[i]; }));
  assert(which.size() == static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1)));
}

} // namespace

void NeighbourLists::assert_sound() const {
  if (!made_ || ranges_.size() > max_checked)
    return;
  assert(0 <= window_age_ && window_age_ < window_);
  assert(0 <= age_ && age_ - window_age_ + window_ <= life_);
  std::vector<Range> in_order = ranges_;
  std::sort(in_order.begin(), in_order.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  std::size_t end = 0;
  for (const Range& range : in_order) {
    assert(range.count <= range.room && end <= range.begin); // nobody writes into the room of another
    end = std::size_t{range.begin} + range.room;
  }
  assert(end + kernel_padding <= entries_.size());
  assert_mutual(*this, ranges_.size());
  assert(is_anew_.size() == ranges_.size() && is_touched_.size() == ranges_.size());
  assert_marked(anew_, is_anew_);
  assert_marked(touched_, is_touched_);
}

} // namespace keeler

#endif
