// A set of particle indices: each member once, in the order of insertion, and a flag for each particle.
//
// Invariant: i is a member exactly if its flag is set (except for members beyond a reduced size, until reset()).
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace keeler::collision {

class MarkedSet {
public:
  /// Empties the set, for indices below `count`.
  void reset(std::size_t count) {
    members_.clear();
    marks_.assign(count, 0);
  }
  /// Changes the bound of the indices and keeps the members. Precondition: reset() follows if the bound is lowered.
  void resize(std::size_t count) { marks_.resize(count); }

  void insert(std::size_t i) {
    assert(i < marks_.size());
    if (!marks_[i])
      members_.push_back(static_cast<std::uint32_t>(i));
    marks_[i] = 1;
  }

  bool contains(std::size_t i) const { return marks_[i] != 0; }
  std::size_t size() const { return members_.size(); }
  bool empty() const { return members_.empty(); }
  std::span<const std::uint32_t> members() const { return members_; }
  std::size_t bytes() const { return members_.capacity() * sizeof(std::uint32_t) + marks_.capacity(); }

  /// True if the invariant holds for indices below `count`.
  bool sound(std::size_t count) const {
    return marks_.size() == count &&
           std::all_of(members_.begin(), members_.end(), [&](std::uint32_t i) { return i < count && marks_[i]; }) &&
           members_.size() == static_cast<std::size_t>(std::count(marks_.begin(), marks_.end(), 1));
  }

private:
  std::vector<std::uint32_t> members_;
  std::vector<std::uint8_t> marks_;
};

} // namespace keeler::collision
