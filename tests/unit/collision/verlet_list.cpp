// The symmetric lists by themselves: laid out, filled, and replaced one by one, against a matrix of pairs.
#include "neighbours/verlet_list.hpp"

#include "neighbours/listed_pairs.hpp"
#include "neighbours/marked_set.hpp"

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace verlet_list_test {

using namespace keeler;
using namespace keeler::collision;

namespace {

// Lists of some particles, and the same pairs in the plainest form.
struct Matrix {
  RandomStream random;
  std::size_t count;
  std::vector<std::uint8_t> is_pair;
  VerletList lists;

  Matrix(std::uint64_t seed, std::size_t particles)
      : random(seed, RandomPurpose::position, 0), count(particles), is_pair(particles * particles) {
    std::vector<std::uint32_t> lengths(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (random.uniform() < 0.2) {
          set(i, j, true);
          ++lengths[reversed(i)];
          ++lengths[reversed(j)];
        }
    lists.lay_out(lengths, [&](std::size_t k) { return reversed(k); });
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::uint32_t j = 0; j < count; ++j)
        if (pair(i, j))
          lists.put(i, j);
  }

  std::uint32_t reversed(std::size_t k) const { return static_cast<std::uint32_t>(count - 1 - k); }
  bool pair(std::size_t i, std::size_t j) const { return is_pair[i * count + j]; }
  void set(std::size_t i, std::size_t j, bool value) { is_pair[i * count + j] = is_pair[j * count + i] = value; }

  void replace(std::uint32_t i, double probability) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t j = 0; j < count; ++j) {
      set(i, j, j != i && random.uniform() < probability);
      if (j == i || pair(i, j))
        found.push_back(j);
    }
    lists.replace(i, found);
  }

  bool agrees() const {
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<std::uint32_t> expected, found(lists.list(i).begin(), lists.list(i).end());
      for (std::uint32_t j = 0; j < count; ++j)
        if (pair(i, j))
          expected.push_back(j);
      std::sort(found.begin(), found.end());
      if (found != expected || lists.length(i) != found.size())
        return false;
    }
    return true;
  }
};

} // namespace

TEST_CASE("lists hold what was put into them, and stay symmetric when single ones are replaced") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Matrix matrix(seed, 30);
    CHECK(matrix.lists.size() == 30);
    CHECK(matrix.agrees());
    CHECK(matrix.lists.sound());
    for (int k = 0; k < 60; ++k) {
      matrix.replace(static_cast<std::uint32_t>(30.0 * matrix.random.uniform()), matrix.random.uniform());
      CHECK(matrix.agrees());
      CHECK(matrix.lists.sound());
    }
  }
}

TEST_CASE("an asymmetric list is not sound") {
  VerletList lists;
  lists.lay_out(std::vector<std::uint32_t>{1, 1, 1}, [](std::size_t k) { return static_cast<std::uint32_t>(k); });
  CHECK(lists.sound());
  lists.put(0, 2);
  CHECK_FALSE(lists.sound());
  lists.put(2, 0);
  CHECK(lists.sound());
  lists.put(1, 1);
  CHECK_FALSE(lists.sound());
}

TEST_CASE("lists that have been replaced over and over are outgrown until they are laid out again") {
  Matrix matrix(1, 150);
  CHECK_FALSE(matrix.lists.outgrown());
  for (int k = 0; k < 2000 && !matrix.lists.outgrown(); ++k)
    matrix.replace(static_cast<std::uint32_t>(k % 150), 0.02 * (k % 50));
  CHECK(matrix.lists.outgrown());
  CHECK(matrix.lists.sound());
  matrix.lists.lay_out(std::vector<std::uint32_t>(150), [](std::size_t k) { return static_cast<std::uint32_t>(k); });
  CHECK_FALSE(matrix.lists.outgrown());
}

TEST_CASE("the lists of marked particles give each of their pairs once, in any blocks") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Matrix matrix(seed, 200);
    MarkedSet marked;
    marked.reset(200);
    for (std::size_t k = 0; k < 10 * seed; ++k)
      marked.insert(static_cast<std::size_t>(200.0 * matrix.random.uniform()));
    CHECK(marked.sound(200));
    std::set<std::pair<std::size_t, std::size_t>> found;
    std::size_t visited = 0, expected = 0;
    for (std::size_t block = 0; block < marked_blocks(marked); ++block) {
      const PaddedPairs pairs = pairs_of_lists(matrix.lists, marked_members(marked, block), marked);
      for (std::size_t k = 0; k < pair_count(pairs); ++k) {
        CHECK(matrix.pair(pairs[k].first, pairs[k].second));
        found.insert(std::minmax<std::size_t>(pairs[k].first, pairs[k].second));
        ++visited;
      }
    }
    for (std::size_t i = 0; i < 200; ++i)
      for (std::size_t j = 0; j < i; ++j)
        expected += matrix.pair(i, j) && (marked.contains(i) || marked.contains(j));
    CHECK(visited == found.size());
    CHECK(visited == expected);
  }
}

TEST_CASE("a marked set holds each member once, in the order of insertion") {
  MarkedSet set;
  set.reset(10);
  for (const std::size_t i : {7, 3, 7, 9, 3})
    set.insert(i);
  CHECK(std::ranges::equal(set.members(), std::vector<std::uint32_t>{7, 3, 9}));
  CHECK(set.contains(9));
  CHECK_FALSE(set.contains(8));
  CHECK(set.sound(10));
  set.resize(5);
  CHECK_FALSE(set.sound(5)); // until it is reset
  set.reset(5);
  CHECK(set.empty());
  CHECK(set.sound(5));
}

} // namespace verlet_list_test
