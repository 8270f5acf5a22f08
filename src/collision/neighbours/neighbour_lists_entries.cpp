// The entries of the lists: finding all pairs, writing them down, and exchanging those of one particle.
#include "neighbour_lists.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/threads.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace keeler {

// A run of slots for a thread, whose pairs it finds and whose entries it writes.
struct NeighbourLists::Parts {
  explicit Parts(std::size_t blocks, std::size_t slots)
      : count(std::max<std::size_t>(1, std::min(blocks, static_cast<std::size_t>(threads())))), blocks_(blocks),
        slots_(slots), crossing(count) {}
  std::size_t first_block(std::size_t part) const { return blocks_ * part / count; }
  std::size_t first_slot(std::size_t part) const { return std::min(slots_, first_block(part) * block_size); }

  std::size_t count;

private:
  std::size_t blocks_, slots_;

public:
  std::vector<std::vector<LinePair>> crossing; // pairs whose second slot is another part's
  std::vector<std::uint32_t> entries;          // of each slot
};

// Each thread finds the pairs of its part and counts the entries of its slots; pairs that cross parts are few, and
// counted afterwards.
void NeighbourLists::find_pairs() {
  const std::size_t count = cells_.size(), blocks_count = (count + block_size - 1) / block_size;
  Parts parts(blocks_count, count);
  parts.entries.assign(count, 0);
  pairs_.resize(blocks_count);
  std::vector<std::uint64_t> tests(parts.count);
  const LineSpan span = wider(-half_life(), half_life(), half_life());
  parallel_for(
      parts.count,
      [&](std::size_t p) {
        const std::size_t begin = parts.first_slot(p), end = parts.first_slot(p + 1);
        std::vector<LinePair> buffer;
        for (std::size_t b = parts.first_block(p); b < parts.first_block(p + 1) && !interrupted(); ++b) {
          Pairs& pairs = pairs_[b];
          pairs.clear();
          const std::size_t first = b * block_size, last = std::min(count, first + block_size);
          tests[p] += cells_.sweep_pairs(first, last, span, buffer, [&](std::uint32_t i, std::uint32_t j) {
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
  const std::uint64_t tested_now = std::accumulate(tests.begin(), tests.end(), std::uint64_t{0});
  tested += tested_now;
  cost_ = 60.0 * static_cast<double>(count) + 1.3 * static_cast<double>(tested_now);
  lay_out(parts);
  fill(parts);
}

// Lists follow each other in the order of slots, each with some room for more.
void NeighbourLists::lay_out(const Parts& parts) {
  const std::size_t count = cells_.size();
  ranges_.resize(count);
  std::uint64_t begin = 0, entries = 0;
  for (std::size_t slot = 0; slot < count; ++slot) {
    const std::uint32_t own = parts.entries[slot], room = own + own / 4 + 2;
    ranges_[cells_.place(slot)] = {static_cast<std::uint32_t>(begin), 0, room};
    begin += room;
    entries += own;
  }
  if (begin > std::uint64_t{1} << 31)
    throw InvariantError(
        fmt::format("neighbour lists of {} entries are too long; take a shorter step or fewer particles", begin));
  listed += entries / 2;
  cost_ += 6.0 * static_cast<double>(entries);
  entries_made_ = begin;
  entries_.assign(begin + kernel_padding, 0);
  anew_.clear();
  is_anew_.assign(count, 0);
  is_touched_.resize(count); // for whoever is listed anew before the first window
  times_anew_ = 0;
}

// The entries of all lists; the pairs turn from slots into places.
void NeighbourLists::fill(const Parts& parts) {
  const auto put = [&](std::uint32_t place, std::uint32_t entry) {
    Range& range = ranges_[place];
    entries_[range.begin + range.count++] = entry;
  };
  parallel_for(
      parts.count,
      [&](std::size_t p) {
        const std::size_t begin = parts.first_slot(p), end = parts.first_slot(p + 1);
        for (std::size_t b = parts.first_block(p); b < parts.first_block(p + 1); ++b) {
          for (LinePair& pair : pairs_[b]) {
            const LinePair places{cells_.place(pair.first), cells_.place(pair.second)};
            put(places.first, places.second);
            if (pair.second - begin < end - begin)
              put(places.second, places.first);
            pair = places;
          }
          pairs_[b].resize(pairs_[b].size() + kernel_padding);
        }
      },
      1);
  for (const std::vector<LinePair>& crossing : parts.crossing)
    for (const LinePair& pair : crossing)
      put(cells_.place(pair.second), cells_.place(pair.first));
}

void NeighbourLists::replace_list(std::uint32_t i, std::span<const std::uint32_t> found) {
  for (const std::uint32_t j : list(i))
    erase(j, i);
  ranges_[i].count = 0;
  if (ranges_[i].room < found.size())
    grow(ranges_[i], static_cast<std::uint32_t>(found.size()));
  Range& range = ranges_[i];
  for (const std::uint32_t j : found)
    if (j != i) {
      entries_[range.begin + range.count++] = j;
      append(j, i);
    }
}

void NeighbourLists::erase(std::uint32_t of, std::uint32_t entry) {
  Range& range = ranges_[of];
  std::uint32_t* const entries = entries_.data() + range.begin;
  std::uint32_t* const at = std::find(entries, entries + range.count, entry);
  assert(at < entries + range.count); // entries are mutual
  *at = entries[--range.count];
}

void NeighbourLists::append(std::uint32_t to, std::uint32_t entry) {
  Range& range = ranges_[to];
  if (range.count == range.room)
    grow(range, range.count + 1);
  entries_[range.begin + range.count++] = entry;
}

// Moves a list to where there is room.
void NeighbourLists::grow(Range& range, std::uint32_t room) {
  const std::size_t begin = entries_.size() - kernel_padding;
  room += room / 4 + 2;
  entries_.resize(entries_.size() + room, 0);
  std::copy_n(entries_.begin() + range.begin, range.count, entries_.begin() + static_cast<std::ptrdiff_t>(begin));
  range.begin = static_cast<std::uint32_t>(begin);
  range.room = room;
}

} // namespace keeler
