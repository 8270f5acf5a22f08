#include <keeler/core/large_blocks.hpp>

#include "draws.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <vector>

namespace large_blocks_test {

using namespace keeler;

constexpr std::size_t page = LargeBlocks::page, unit = LargeBlocks::unit;

struct Block {
  std::byte* begin;
  std::size_t bytes;
  std::byte mark;
};

// Writes a mark into the first byte of each page and the last byte of the block.
void fill(const Block& block) {
  for (std::size_t at = 0; at < block.bytes; at += page)
    block.begin[at] = block.mark;
  block.begin[block.bytes - 1] = block.mark;
}

bool is_whole(const Block& block) {
  bool whole = block.begin[block.bytes - 1] == block.mark;
  for (std::size_t at = 0; at < block.bytes; at += page)
    whole = whole && block.begin[at] == block.mark;
  return whole;
}

std::size_t pages_of(std::size_t bytes) {
  return (bytes + page - 1) / page * page;
}

// Returns the units that blocks are in, in bytes.
std::size_t units_with(const std::vector<Block>& blocks) {
  std::set<std::uintptr_t> units;
  for (const Block& block : blocks) {
    const auto begin = reinterpret_cast<std::uintptr_t>(block.begin);
    for (std::uintptr_t k = begin / unit; k * unit < begin + block.bytes; ++k)
      units.insert(k);
  }
  return units.size() * unit;
}

TEST_CASE("blocks keep what is written into them, and units without blocks are kept up to what was once used") {
  LargeBlocks blocks(24 * unit);
  std::vector<Block> taken; // the plain twin: what is in use
  std::size_t most = 0, refused = 0, kept = 0;
  std::uint64_t seed = 12345;
  const auto draw = [&seed](std::uint64_t below) { // Knuth's linear congruential generator
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (seed >> 33) % below;
  };
  for (std::uint64_t k = 0; k < test::draws(6000); ++k) {
    if (taken.size() < 3 || (taken.size() < 40 && draw(2) == 0)) {
      const std::size_t bytes = 1 + draw(draw(4) == 0 ? 4 * unit : unit / 4);
      auto* const begin = static_cast<std::byte*>(blocks.take(bytes));
      refused += !begin;
      if (!begin)
        continue;
      REQUIRE(reinterpret_cast<std::uintptr_t>(begin) % page == 0);
      fill(taken.emplace_back(Block{begin, bytes, static_cast<std::byte>(k)}));
    } else {
      std::swap(taken[draw(taken.size())], taken.back());
      REQUIRE(is_whole(taken.back()));
      REQUIRE(blocks.give_back(taken.back().begin));
      taken.pop_back();
    }
    std::size_t used = 0;
    for (const Block& block : taken)
      used += pages_of(block.bytes);
    most = std::max(most, used);
    REQUIRE(blocks.used() == used);
    REQUIRE(blocks.most_used() == most);
    REQUIRE(blocks.held() >= units_with(taken));
    REQUIRE(blocks.held() <= std::max(units_with(taken), most));
    kept += blocks.held() > units_with(taken);
  }
  CHECK(kept > 0);
  CHECK(refused > 0); // 24 units are too few at times
  for (const Block& block : taken)
    CHECK(is_whole(block));
}

// Takes blocks of these numbers of units, one after the other, and writes into all of them.
template<std::size_t n> std::array<void*, n> take_all(LargeBlocks& blocks, const std::array<std::size_t, n>& units) {
  std::array<void*, n> taken{};
  for (std::size_t k = 0; k < n; ++k)
    std::memset(taken[k] = blocks.take(units[k] * unit), static_cast<int>(k + 1), units[k] * unit);
  return taken;
}

TEST_CASE("sets of arrays, one after the other, need no new memory where each fits into what the last ones left") {
  LargeBlocks blocks(100 * unit);
  for (const std::array<std::size_t, 3>& units :
       {std::array<std::size_t, 3>{25, 15, 10}, {24, 14, 10}, {25, 15, 10}, {22, 15, 6}, {25, 15, 10}})
    for (void* const block : take_all<3>(blocks, units))
      CHECK(blocks.give_back(block));
  CHECK(blocks.fetched() == 50 * unit);
  CHECK(blocks.held() == 50 * unit);
  CHECK(blocks.most_used() == 50 * unit);
}

TEST_CASE("a block goes where the fewest units need memory, and of such ranges into the shortest") {
  LargeBlocks blocks(100 * unit);
  const auto taken = take_all<5>(blocks, {8, 1, 4, 1, 2});
  CHECK(blocks.give_back(taken[0]));
  CHECK(blocks.give_back(taken[2]));
  CHECK(blocks.take(3 * unit) == taken[2]);
  CHECK(blocks.take(7 * unit) == taken[0]);
  CHECK(blocks.fetched() == 16 * unit);

  LargeBlocks others(8 * unit);
  const auto first = take_all<2>(others, {4, 1});
  CHECK(others.give_back(first[0]));
  CHECK(others.take(2 * unit + page) == first[0]); // though the free end is shorter
}

TEST_CASE("a block may begin within a unit and end with it") {
  LargeBlocks blocks(10 * unit);
  auto* const one = static_cast<std::byte*>(blocks.take(page));
  CHECK(blocks.take(unit - page) == one + page);
  CHECK(blocks.held() == unit);
  CHECK(blocks.take(unit) == one + unit);
  CHECK(blocks.held() == 2 * unit);
}

TEST_CASE("free ranges that touch are one; addresses are of whole units") {
  LargeBlocks blocks(4 * unit), odd(unit + 1);
  const auto taken = take_all<2>(blocks, {2, 2});
  CHECK(blocks.give_back(taken[0]));
  CHECK(blocks.give_back(taken[1]));
  CHECK(blocks.take(4 * unit) == taken[0]);
  CHECK(odd.take(2 * unit) != nullptr);
}

TEST_CASE("what is held beyond the most that was used is released, the last units first") {
  LargeBlocks blocks(12 * unit);
  const auto taken = take_all<4>(blocks, {2, 1, 2, 1});
  CHECK(blocks.give_back(taken[0]));
  CHECK(blocks.give_back(taken[2]));
  auto* const last = static_cast<std::byte*>(blocks.take(3 * unit)); // longer than both
  CHECK(std::all_of(last, last + 3 * unit, [](std::byte b) { return b == std::byte{0}; }));
  CHECK(blocks.fetched() == 9 * unit);
  CHECK(blocks.most_used() == 6 * unit);
  CHECK(blocks.held() == 6 * unit);
  CHECK(blocks.take(unit) == taken[0]);
  CHECK(blocks.fetched() == 9 * unit);
}

TEST_CASE("a released unit is empty when it is used again") {
  LargeBlocks blocks(10 * unit);
  const auto taken = take_all<2>(blocks, {3, 1});
  CHECK(blocks.give_back(taken[0]));
  blocks.take(4 * unit); // where no memory is yet: the three go
  CHECK(blocks.most_used() == 5 * unit);
  CHECK(blocks.held() == 5 * unit);
  auto* const again = static_cast<std::byte*>(blocks.take(3 * unit));
  CHECK(again == taken[0]);
  CHECK(std::all_of(again, again + 3 * unit, [](std::byte b) { return b == std::byte{0}; }));
}

TEST_CASE("only blocks that were taken are given back, and memory that is not there is not given") {
  LargeBlocks blocks(10 * unit), none(std::size_t{1} << 62);
  std::byte other{};
  CHECK_FALSE(blocks.give_back(&other));
  CHECK_FALSE(none.give_back(&other));
  CHECK(none.take(1) == nullptr);
  CHECK(blocks.take(10 * unit + 1) == nullptr);
  CHECK(blocks.take(std::numeric_limits<std::size_t>::max()) == nullptr);
  CHECK(blocks.used() == 0);
  CHECK(blocks.most_used() == 0);
  auto* const block = static_cast<std::byte*>(blocks.take(1));
  CHECK(blocks.used() == page);
  CHECK_FALSE(blocks.give_back(block + 1));
  CHECK_FALSE(blocks.give_back(block + page));
  CHECK(blocks.give_back(block));
  CHECK_FALSE(blocks.give_back(block));
  CHECK(blocks.take(10 * unit) == block);
  CHECK(blocks.take(1) == nullptr);
}

} // namespace large_blocks_test
