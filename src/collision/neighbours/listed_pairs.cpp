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

} // namespace

// The slots divided among threads: each finds the pairs of its part and writes the entries of its slots.
struct ListedPairs::Parts {
  explicit Parts(std::size_t slot_count)
      : slots(slot_count), blocks((slot_count + slots_per_block - 1) / slots_per_block),
        count(std::max<std::size_t>(1, std::min(blocks, static_cast<std::size_t>(threads())))), crossing(count),
        entries(slot_count, 0) {}
  std::size_t first_block(std::size_t part) const { return blocks * part / count; }
  std::size_t first_slot(std::size_t part) const { return std::min(slots, first_block(part) * slots_per_block); }

  std::size_t slots, blocks, count;
  std::vector<std::vector<LinePair>> crossing; // pairs with the second slot in another part
  std::vector<std::uint32_t> entries;          // of each slot
};

ListedPairs::Rebuild ListedPairs::rebuild(const LineCells& cells, double half, VerletList& list) {
  assert(cells.one_image());
  Parts parts(cells.size());
  Rebuild done;
  done.tested = find(cells, half, parts);
  done.entries = std::accumulate(parts.entries.begin(), parts.entries.end(), std::uint64_t{0});
  list.lay_out(parts.entries, [&](std::size_t slot) { return cells.particle(slot); });
  renewed_.reset(cells.size());
  fill(cells, parts, list);
  return done;
}

// Finds the pairs, as slots, and counts the entries of each slot. Pairs that cross parts are few and counted at the
// end.
std::uint64_t ListedPairs::find(const LineCells& cells, double half, Parts& parts) {
  found_.resize(parts.blocks);
  std::vector<std::uint64_t> tests(parts.count);
  const LineSpan span = widened(-half, half, half);
  parallel_for(
      parts.count,
      [&](std::size_t p) {
        const std::size_t begin = parts.first_slot(p), end = parts.first_slot(p + 1);
        std::vector<LinePair> buffer;
        for (std::size_t b = parts.first_block(p); b < parts.first_block(p + 1) && !interrupted(); ++b) {
          PaddedPairs& pairs = found_[b];
          pairs.clear();
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

// Writes the entries of all lists; the pairs turn from slots into particles.
void ListedPairs::fill(const LineCells& cells, const Parts& parts, VerletList& list) {
  parallel_for(
      parts.count,
      [&](std::size_t p) {
        const std::size_t begin = parts.first_slot(p), end = parts.first_slot(p + 1);
        for (std::size_t b = parts.first_block(p); b < parts.first_block(p + 1); ++b) {
          for (LinePair& pair : found_[b]) {
            const LinePair particles{cells.particle(pair.first), cells.particle(pair.second)};
            list.put(particles.first, particles.second);
            if (pair.second - begin < end - begin)
              list.put(particles.second, particles.first);
            pair = particles;
          }
          found_[b].resize(found_[b].size() + kernel_padding);
        }
      },
      1);
  for (const std::vector<LinePair>& crossing : parts.crossing)
    for (const LinePair& pair : crossing)
      list.put(cells.particle(pair.second), cells.particle(pair.first));
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

bool ListedPairs::sound(const VerletList& list) const {
  if (!renewed_.sound(list.size()))
    return false;
  std::size_t pairs = 0, entries = 0;
  for (std::size_t b = 0; b < blocks(); ++b)
    visit_block(b, list, [&](const PaddedPairs& block) {
      for (std::size_t k = 0; k < pair_count(block); ++k)
        pairs += !(from_rebuild(b) && superseded(block[k]));
    });
  for (std::size_t i = 0; i < list.size(); ++i)
    entries += list.length(i);
  return 2 * pairs == entries;
}

std::size_t ListedPairs::bytes() const {
  std::size_t total = renewed_.bytes() + found_.capacity() * sizeof(PaddedPairs);
  for (const PaddedPairs& pairs : found_)
    total += pairs.capacity() * sizeof(LinePair);
  return total;
}

} // namespace keeler::collision
