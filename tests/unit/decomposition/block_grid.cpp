// Blocks against a search through all images, which needs no cleverness.
#include "block_grid.hpp"

#include <keeler/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace keeler;
using decomposition::BlockGrid, decomposition::Point;

namespace {

const ShearingBox patch{300.0, 120.0, 1.5, 0.0};

// Returns positions of the cell, half of them in a clump.
std::vector<Point> positions(std::size_t count, std::uint64_t seed) {
  std::vector<Point> all;
  for (std::size_t k = 0; k < count; ++k) {
    RandomStream random(seed, RandomPurpose::position, k);
    const double width = k % 2 == 0 ? 1.0 : 0.1;
    const double x = width * (random.uniform() - 0.5), y = width * (random.uniform() - 0.5);
    all.push_back({patch.size_x * x, patch.size_y * y});
  }
  return all;
}

struct Division {
  std::size_t ranks, strips;
};
const Division divisions[] = {{1, 1}, {2, 2}, {2, 1}, {4, 2}, {7, 3}, {12, 4}, {12, 1}, {12, 12}};

BlockGrid grid_of(const Division& division, const std::vector<Point>& at) {
  BlockGrid grid(patch, division.ranks);
  grid.divide(division.strips);
  grid.balance(at, std::vector<std::uint64_t>(at.size(), 1), {});
  return grid;
}

// True if an image of the first position is within `reach` of the second.
bool near(const Point& a, const Point& b, const Point& reach, double offset) {
  for (int nx = -4; nx <= 4; ++nx)
    for (int ny = -20; ny <= 20; ++ny)
      if (std::fabs(a.x + nx * patch.size_x - b.x) <= reach.x &&
          std::fabs(a.y + ny * patch.size_y - nx * offset - b.y) <= reach.y)
        return true;
  return false;
}

} // namespace

TEST_CASE("blocks of equal weight: each position has one owner, and no rank much more than the mean") {
  const std::vector<Point> at = positions(20000, 1);
  std::vector<std::uint64_t> weights;
  for (std::size_t k = 0; k < at.size(); ++k)
    weights.push_back(at[k].x > 0.0 ? 5 : 1);
  for (const Division& division : divisions) {
    CAPTURE(division.ranks);
    CAPTURE(division.strips);
    BlockGrid grid(patch, division.ranks);
    grid.divide(division.strips);
    grid.balance(at, weights, {});
    CHECK(grid.strips() == division.strips);
    std::vector<std::uint64_t> loads(division.ranks);
    for (std::size_t k = 0; k < at.size(); ++k) {
      const std::size_t owner = grid.owner(at[k]);
      loads[owner] += weights[k];
      CHECK(grid.is_within(at[k], owner, {1e-9, 1e-9}, 17.0));
      for (std::size_t rank = 0; rank < division.ranks; ++rank) // the others' blocks are elsewhere
        if (rank != owner && grid.is_within(at[k], rank, {0.0, 0.0}, 17.0))
          CHECK(grid.is_within(at[k], rank, {-1e-9, -1e-9}, 17.0) == false);
    }
    const auto all = std::accumulate(loads.begin(), loads.end(), std::uint64_t{0});
    CHECK(*std::max_element(loads.begin(), loads.end()) * division.ranks < 1.1 * static_cast<double>(all));
  }
}

TEST_CASE("a block's ghosts are all positions with an image within reach of one of its own") {
  const std::vector<Point> at = positions(400, 2);
  for (const Division& division : divisions)
    for (const Point& reach : {Point{5.0, 9.0}, Point{40.0, 3.0}, Point{200.0, 20.0}, Point{0.5, 80.0}})
      for (const double offset : {0.0, 31.0, 119.0}) {
        const BlockGrid grid = grid_of(division, at);
        for (std::size_t a = 0; a < at.size(); a += 3)
          for (std::size_t b = 0; b < at.size(); ++b) {
            const std::size_t rank = grid.owner(at[b]);
            if (!near(at[a], at[b], reach, offset))
              continue;
            REQUIRE(grid.is_within(at[a], rank, reach, offset));
            const std::size_t own = grid.owner(at[a]);
            const std::vector<std::size_t> neighbours = grid.neighbours(own, reach, offset);
            REQUIRE((own == rank || std::binary_search(neighbours.begin(), neighbours.end(), rank)));
          }
      }
}

TEST_CASE("blocks are no larger than they must be: positions out of reach are no ghosts") {
  const std::vector<Point> at = positions(3000, 3);
  const BlockGrid grid = grid_of({12, 4}, at);
  const Point reach{6.0, 4.0};
  std::size_t ghosts = 0;
  for (std::size_t rank = 0; rank < 12; ++rank)
    for (const Point& position : at) {
      bool is_near = false; // to a fine raster of the block's positions
      for (const Point& other : at)
        is_near =
            is_near || (grid.owner(other) == rank && near(position, other, {reach.x + 25.0, reach.y + 20.0}, 7.0));
      const bool is_ghost = grid.is_within(position, rank, reach, 7.0) && grid.owner(position) != rank;
      ghosts += is_ghost;
      REQUIRE((is_near || !is_ghost));
    }
  CHECK(ghosts > 100);
}

TEST_CASE("few ranks have slabs, many have blocks, and a thin reach changes nothing") {
  const ShearingBox square{1000.0, 1000.0, 1.5, 0.0}, wide{4000.0, 200.0, 1.5, 0.0}, high{200.0, 4000.0, 1.5, 0.0};
  const Point reach{30.0, 50.0};
  CHECK(BlockGrid(square, 2).best_strips(reach) == 2);
  CHECK(BlockGrid(square, 4).best_strips(reach) == 4);
  CHECK(BlockGrid(square, 64).best_strips(reach) < 16);
  CHECK(BlockGrid(square, 64).best_strips(reach) > 4);
  CHECK(BlockGrid(wide, 16).best_strips(reach) == 16);
  CHECK(BlockGrid(high, 16).best_strips(reach) == 1);
  CHECK(BlockGrid(square, 64).best_strips({0.0, 0.0}) == 64);
  // 8 × 8 blocks of 125 m: (125 + 60)(125 + 100) / 125² − 1, and 7/8 of the particles are guests of the mesh
  CHECK(BlockGrid(square, 64).cost(8, reach) == doctest::Approx(1.664 + 0.05 * 0.875));
}
