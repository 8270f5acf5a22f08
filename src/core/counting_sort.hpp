// Parallel stable counting sort of items by cell.
#pragma once

#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <numeric>
#include <span>

namespace keeler {

/// Calls put(k, position) once for every item k, in unspecified order: the items of cell c get the positions
/// [starts[c], starts[c + 1]), in the order of k. `starts` is resized to cells + 1. put must write only data of k or
/// position. Precondition: cell_of[k] < cells, and cells and items are below 2³².
///
/// Each thread counts and moves the items of a part of the cells. It scans all items for that, but skips blocks without
/// a cell of its part: few remain when the items are nearly sorted already. A single block is handled by one thread.
template<class Put>
void counting_sort(std::span<const std::uint32_t> cell_of, std::size_t cells, std::vector<std::uint32_t>& starts,
                   const Put& put) {
  constexpr std::size_t block = 1024;
  assert(cells <= (std::uint64_t{1} << 32) && cell_of.size() < (std::uint64_t{1} << 32));
  const std::size_t count = cell_of.size(), blocks = (count + block - 1) / block;
  const std::size_t parts = std::clamp<std::size_t>(blocks, 1, static_cast<std::size_t>(threads()));
  struct Bounds {
    std::uint32_t min, max;
  };
  std::vector<Bounds> bounds(blocks);
  parallel_for(
      bounds.size(),
      [&](std::size_t b) {
        const auto items = cell_of.subspan(b * block, std::min(block, count - b * block));
        const auto [min, max] = std::minmax_element(items.begin(), items.end());
        assert(*max < cells);
        bounds[b] = {*min, *max};
      },
      16);
  const auto first_cell = [&](std::size_t part) { return cells * part / parts; };
  const auto for_items_of = [&](std::size_t part, const auto& body) {
    const std::size_t begin = first_cell(part), end = first_cell(part + 1);
    for (std::size_t b = 0; b < bounds.size(); ++b)
      if (bounds[b].min < end && bounds[b].max >= begin)
        for (std::size_t k = b * block; k < std::min(count, (b + 1) * block); ++k)
          if (cell_of[k] - begin < end - begin)
            body(k);
  };

  // during the sort, starts[c + 1] is the position of the next item of cell c, relative to the part's first
  starts.resize(cells + 1);
  starts[0] = 0;
  std::vector<std::uint32_t> before(parts + 1, 0); // items in the parts before
  parallel_for(
      parts,
      [&](std::size_t p) {
        const auto begin = starts.begin() + 1 + static_cast<std::ptrdiff_t>(first_cell(p));
        const auto end = starts.begin() + 1 + static_cast<std::ptrdiff_t>(first_cell(p + 1));
        std::fill(begin, end, 0);
        for_items_of(p, [&](std::size_t k) { ++starts[cell_of[k] + 1]; });
        before[p + 1] = std::accumulate(begin, end, std::uint32_t{0});
        std::exclusive_scan(begin, end, begin, std::uint32_t{0});
      },
      1);
  std::partial_sum(before.begin(), before.end(), before.begin());
  parallel_for(
      parts,
      [&](std::size_t p) {
        for_items_of(p, [&](std::size_t k) { put(k, before[p] + starts[cell_of[k] + 1]++); });
        for (std::size_t c = first_cell(p); p > 0 && c < first_cell(p + 1); ++c)
          starts[c + 1] += before[p];
      },
      1);
}

} // namespace keeler
