#include <keeler/core/large_blocks.hpp>

#include "draws.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace large_blocks_test {

using namespace keeler;

constexpr std::size_t page = LargeBlocks::page;

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

// Takes blocks of these numbers of pages, one after the other, and writes into all of them.
template<std::size_t n> std::array<void*, n> take_all(LargeBlocks& blocks, const std::array<std::size_t, n>& pages) {
  std::array<void*, n> taken{};
  for (std::size_t k = 0; k < n; ++k)
    std::memset(taken[k] = blocks.take(pages[k] * page), static_cast<int>(k + 1), pages[k] * page);
  return taken;
}

TEST_CASE("sets of arrays, one after the other, need no new pages where each fits into what the last ones left") {
  LargeBlocks blocks;
  for (const std::array<std::size_t, 3>& pages :
       {std::array<std::size_t, 3>{500, 300, 200}, {480, 290, 200}, {500, 300, 200}, {450, 300, 120}, {500, 300, 200}})
    for (void* const block : take_all<3>(blocks, pages))
      CHECK(blocks.give_back(block));
  CHECK(blocks.fetched() == 1000 * page);
  CHECK(blocks.kept() == 1000 * page);
  CHECK(blocks.most_used() == 1000 * page);
}

TEST_CASE("a short block leaves a longer free range whole, and a block longer than all extends the longest") {
  LargeBlocks blocks;
  CHECK(blocks.give_back(blocks.take(152 * page)));
  const auto taken =
      take_all<5>(blocks, {10, 1, 100, 1, 40}); // one after the other: single pages keep free ranges apart
  for (const std::size_t k : {0, 2, 4})
    CHECK(blocks.give_back(taken[k]));
  void* const short_one = blocks.take(10 * page);
  void* const long_one = blocks.take(100 * page);
  CHECK(blocks.fetched() == 152 * page);
  CHECK(blocks.give_back(short_one));
  CHECK(blocks.give_back(long_one));

  auto* const longest = static_cast<std::byte*>(blocks.take(140 * page));
  CHECK(blocks.fetched() == (152 + 40) * page);
  CHECK(std::all_of(longest, longest + 100 * page, [](std::byte b) { return b != std::byte{0}; }));
  CHECK(std::all_of(longest + 100 * page, longest + 140 * page, [](std::byte b) { return b == std::byte{0}; }));

  // 142 of 152 pages are in use, so 10 of the 50 others may stay: the shortest range goes first, and then a part
  CHECK(blocks.kept() == 10 * page);
  unsigned char in_memory = 0;
  CHECK(mincore(taken[0], page, &in_memory) != 0);
  CHECK(errno == ENOMEM);
  CHECK(mincore(taken[4], page, &in_memory) == 0);
}

TEST_CASE("what is kept goes to the system where that makes room") {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    LargeBlocks blocks;
    constexpr std::size_t piece = std::size_t{50} << 20; // bytes
    std::array<void*, 8> pieces{};
    blocks.give_back(blocks.take(pieces.size() * (piece + page))); // the next ones follow each other
    for (void*& block : pieces) {
      block = blocks.take(piece);
      blocks.take(page); // stays, so that free ranges are apart
    }
    for (void* const block : pieces)
      blocks.give_back(block);
    std::ifstream sizes("/proc/self/statm");
    rlim_t pages = 0;
    sizes >> pages;
    const rlim_t bytes = pages * page + piece;
    const rlimit limit{bytes, bytes};
    const bool is_limited = setrlimit(RLIMIT_AS, &limit) == 0;
    const bool has_room = blocks.take(6 * piece) != nullptr && blocks.take(6 * piece) == nullptr;
    _exit(is_limited && has_room ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  CHECK((test::sanitized || status == 0)); // a sanitizer's own memory is beyond such a limit
}

TEST_CASE("only blocks that were taken are given back, and memory that is not there is not given") {
  LargeBlocks blocks;
  std::byte other{};
  CHECK_FALSE(blocks.give_back(&other));
  CHECK(blocks.take(std::size_t{1} << 60) == nullptr);
  CHECK(blocks.take(std::numeric_limits<std::size_t>::max()) == nullptr);
  CHECK(blocks.used() == 0);
  CHECK(blocks.most_used() == 0);
  void* const block = blocks.take(1);
  CHECK(blocks.used() == page);
  CHECK(blocks.give_back(block));
  CHECK_FALSE(blocks.give_back(block));
  CHECK(blocks.take(std::numeric_limits<std::size_t>::max()) == nullptr); // with a free range, too
}

} // namespace large_blocks_test
