// A half-open range of indices.
#pragma once

#include <cassert>
#include <cstddef>

namespace keeler::gravity {

/// Invariant: begin <= end.
struct IndexRange {
  std::size_t begin = 0, end = 0;

  std::size_t size() const {
    assert(begin <= end);
    return end - begin;
  }
  bool contains(std::size_t index) const { return index >= begin && index < end; }
};

} // namespace keeler::gravity
