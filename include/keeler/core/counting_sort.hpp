// The one counting sort: items by the cell that each lies in, and by their numbers within a cell.
#pragma once

#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>

namespace keeler {

/// Calls put(k, place) once for every item k, in no promised order: the items of cell c get the places from starts[c]
/// up to starts[c + 1], in the order of k. `starts` gets cells + 1 entries. put must write only what belongs to k or
/// place.
///
/// Each thread counts and places the items of some of the cells: its part. It reads all items for that, but skips
/// blocks of them that have no cell of its part: few remain when the items stand nearly in order already. Fewer items
/// than a block are one thread's.
template<class Put>
void counting_sort(std::span<const std::uint32_t> cell_of, std::size_t cells, std::vector<std::uint32_t>& starts,
                   const Put& put) {
  constexpr std::size_t block = 1024;
  const std::size_t count = cell_of.size(), blocks = (count + block - 1) / block;
  const std::size_t parts = std::clamp<std::size_t>(blocks, 1, static_cast<std::size_t>(threads()));
  struct Bounds {
    std::uint32_t least, most;
  };
  std::vector<Bounds> bounds(blocks);
  parallel_for(
      bounds.size(),
      [&](std::size_t b) {
        const auto items = cell_of.subspan(b * block, std::min(block, count - b * block));
        const auto [least, most] = std::minmax_element(items.begin(), items.end());
        bounds[b] = {*least, *most};
      },
      16);
  const auto first_cell = [&](std::size_t part) { return cells * part / parts; };
  const auto for_items_of = [&](std::size_t part, const auto& body) {
    const std::size_t begin = first_cell(part), end = first_cell(part + 1);
    for (std::size_t b = 0; b < bounds.size(); ++b)
      if (bounds[b].least < end && bounds[b].most >= begin)
        for (std::size_t k = b * block; k < std::min(count, (b + 1) * block); ++k)
          if (cell_of[k] - begin < end - begin)
            body(k);
  };

  // while it runs, starts[c + 1] is where the next item of cell c goes, counted from the part's first
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
