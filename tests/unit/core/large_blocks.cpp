#include <keeler/core/large_blocks.hpp>

#include "draws.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace large_blocks_test {

using namespace keeler;

constexpr std::size_t page = LargeBlocks::page;

struct Block {
  std::byte* begin;
  std::size_t bytes;
  std::byte mark;
};

// Writes a mark into the first and last byte of each page, as into the last of the block.
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

TEST_CASE("blocks keep what is written into them, and no more pages than were once used") {
  LargeBlocks blocks;
  std::vector<Block> taken; // the plain twin: what is in use
  std::size_t most = 0;
  std::uint64_t seed = 12345;
  const auto draw = [&seed](std::uint64_t below) { // Knuth's linear congruential generator
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (seed >> 33) % below;
  };
  for (std::uint64_t k = 0; k < test::draws(6000); ++k) {
    if (taken.size() < 3 || (taken.size() < 30 && draw(2) == 0)) {
      const std::size_t bytes = 1 + draw(draw(4) == 0 ? 400 * page : 20 * page);
      const Block block{static_cast<std::byte*>(blocks.take(bytes)), bytes, static_cast<std::byte>(k)};
      REQUIRE(block.begin);
      REQUIRE(reinterpret_cast<std::uintptr_t>(block.begin) % page == 0);
      fill(block);
      taken.push_back(block);
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
    REQUIRE(blocks.used() + blocks.kept() <= most);
  }
  CHECK(blocks.kept() > 0);
  for (const Block& block : taken)
    CHECK(is_whole(block));
}

TEST_CASE("arrays of changing sizes, one set after the other, need no new pages") {
  LargeBlocks blocks;
  const auto use = [&blocks](const std::array<std::size_t, 3>& pages) {
    std::array<void*, 3> set{};
    for (std::size_t k = 0; k < set.size(); ++k)
      std::memset(set[k] = blocks.take(pages[k] * page), 1, pages[k] * page);
    for (void* const block : set)
      CHECK(blocks.give_back(block));
  };
  use({500, 300, 200}); // gravity's, for example
  CHECK(blocks.fetched() == 1000 * page);
  CHECK(blocks.kept() == 1000 * page);
  for (const std::size_t more : {0, 7, 20, 33}) {
    use({100 + more, 600 - more, 150}); // the drift's
    use({480, 310 + more, 190 - more});
  }
  CHECK(blocks.fetched() < 1500 * page);
  CHECK(blocks.most_used() == 1000 * page);
}

TEST_CASE("a block longer than all free ranges has the pages of the longest") {
  LargeBlocks blocks;
  void* const first = blocks.take(100 * page);
  std::memset(first, 7, 100 * page);
  void* const held = blocks.take(page);
  CHECK(blocks.give_back(first));
  auto* const longer = static_cast<std::byte*>(blocks.take(140 * page));
  CHECK(blocks.fetched() == 141 * page);
  CHECK(blocks.kept() == 0);
  CHECK(std::all_of(longer, longer + 100 * page, [](std::byte b) { return b == std::byte{7}; }));
  CHECK(std::all_of(longer + 100 * page, longer + 140 * page, [](std::byte b) { return b == std::byte{0}; }));
  CHECK(blocks.give_back(longer));
  CHECK(blocks.give_back(held));
}

TEST_CASE("only blocks that were taken are given back, and memory that is not there is not given") {
  LargeBlocks blocks;
  std::byte other{};
  CHECK_FALSE(blocks.give_back(&other));
  CHECK(blocks.take(std::size_t{1} << 60) == nullptr);
  CHECK(blocks.used() == 0);
  CHECK(blocks.most_used() == 0);
  void* const block = blocks.take(1);
  CHECK(blocks.used() == page);
  CHECK(blocks.give_back(block));
  CHECK_FALSE(blocks.give_back(block));
}

} // namespace large_blocks_test
