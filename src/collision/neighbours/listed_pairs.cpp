#include "listed_pairs.hpp"

#include "step_interval.hpp"

#include <keeler/core/parallel.hpp>
#include <keeler/core/threads.hpp>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler::collision {
namespace {

constexpr std::size_t slots_per_block = 1024;

// The slots divided among threads: each finds the pairs of its part and writes the entries of its slots.
struct SlotParts {
  explicit SlotParts(std::size_t slot_count)
      : slots(slot_count), blocks((slot_count + slots_per_block - 1) / slots_per_block),
        count(std::max<std::size_t>(1, std::min(blocks, static_cast<std::size_t>(threads())))), found(blocks),
        crossing(count), entries(slot_count, 0) {}
  std::size_t first_block(std::size_t part) const { return blocks * part / count; }
  std::size_t first_slot(std::size_t part) const { return std::min(slots, first_block(part) * slots_per_block); }

  std::size_t slots, blocks, count;
  std::vector<std::vector<LinePair>> found;    // pairs of slots, by block of the first
  std::vector<std::vector<LinePair>> crossing; // pairs with the second slot in another part
  std::vector<std::uint32_t> entries;          // of each slot
};

// Finds the pairs, as slots, and counts the entries of each slot. Pairs that cross parts are few and counted at the
// end.
std::uint64_t find_pairs(const LineCells& cells, double half, SlotParts& parts) {
  std::vector<std::uint64_t> tests(parts.count);
  const LineSpan span = widened(-half, half, half);
  parallel_for(
      parts.count,
      [&](std::size_t p) {
        const std::size_t begin = parts.first_slot(p), end = parts.first_slot(p + 1);
        std::vector<LinePair> buffer;
        for (std::size_t b = parts.first_block(p); b < parts.first_block(p + 1) && !interrupted(); ++b) {
          std::vector<LinePair>& pairs = parts.found[b];
          const std::size_t first = b * slots_per_block, last = std::min(parts.slots, first + slots_per_block);
          tests[p] += cells.sweep_pairs(first, last, span, buffer, [&](std::uint32_t i, std::uint32_t j) {
            pairs.push_back({i, j});
            ++parts.entries[i];
            if (j - begin < end - begin)
              ++parts.entries[j];
            else
              parts.crossing[p].push_back({i, j});
          });
        }
      },
      1);
  for (const std::vector<LinePair>& crossing : parts.crossing)
    for (const LinePair& pair : crossing)
      ++parts.entries[pair.second];
  return std::accumulate(tests.begin(), tests.end(), std::uint64_t{0});
}

// Writes the entries of all lists.
void fill_entries(const LineCells& cells, const SlotParts& parts, VerletList& list) {
  parallel_for(
      parts.count,
      [&](std::size_t p) {
        const std::size_t begin = parts.first_slot(p), end = parts.first_slot(p + 1);
        for (std::size_t b = parts.first_block(p); b < parts.first_block(p + 1); ++b) {
          for (const LinePair& pair : parts.found[b]) {
            const std::uint32_t i = cells.particle(pair.first), j = cells.particle(pair.second);
            list.put(i, j);
            if (pair.second - begin < end - begin)
              list.put(j, i);
          }
        }
      },
      1);
  for (const std::vector<LinePair>& crossing : parts.crossing)
    for (const LinePair& pair : crossing)
      list.put(cells.particle(pair.second), cells.particle(pair.first));
}

} // namespace

ListRebuild rebuild_lists(const LineCells& cells, double half, VerletList& list) {
  assert(cells.one_image());
  SlotParts parts(cells.size());
  ListRebuild done;
  done.tested = find_pairs(cells, half, parts);
  done.entries = std::accumulate(parts.entries.begin(), parts.entries.end(), std::uint64_t{0});
  list.lay_out(parts.entries, [&](std::size_t slot) { return cells.particle(slot); });
  fill_entries(cells, parts, list);
  return done;
}

PaddedPairs pairs_of_lists(const VerletList& list, std::span<const std::uint32_t> particles, const MarkedSet& marked) {
  std::size_t room = kernel_padding, count = 0;
  for (const std::uint32_t i : particles)
    room += list.length(i);
  PaddedPairs pairs(room);
  for (const std::uint32_t i : particles) {
    assert(marked.contains(i));
    for (const std::uint32_t j : list.list(i)) {
      pairs[count] = {i, j};
      count += !marked.contains(j) || i < j;
    }
  }
  pairs.resize(count + kernel_padding);
  return pairs;
}

} // namespace keeler::collision
