#include "sphere_neighbours.hpp"

#include "size_levels.hpp"

#include <keeler/core/memory.hpp>
#include <keeler/core/parallel.hpp>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace keeler::initial_conditions {
namespace {

struct SpherePair {
  std::uint32_t larger;
  Neighbour smaller;
};
using PairBlocks = std::vector<std::vector<SpherePair>>; // one per block of larger partners

// Finds the smaller partners of each sphere: of the order of r² N / area, τ N in total, for any sizes.
PairBlocks find_pairs(const std::vector<Sphere>& spheres, std::size_t own, const ShearingBox& box, double offset,
                      double skin) {
  constexpr std::size_t block = 1024;
  const std::size_t count = spheres.size();
  const SizeLevels levels(spheres, box, offset);
  const auto find_for = [&](std::size_t i, std::vector<SpherePair>& pairs) {
    const Sphere& sphere = spheres[i];
    const auto consider = [&](std::size_t j, const Image& image) {
      const Sphere& other = spheres[j];
      if (j == i || other.radius > sphere.radius || (other.radius == sphere.radius && j > i) || std::min(i, j) >= own)
        return;
      const double range = (sphere.radius + other.radius) * (1.0 + skin);
      const Vec3 d = sphere.position - other.position - box.displacement(image, offset);
      if (d.squaredNorm() < range * range)
        pairs.push_back({static_cast<std::uint32_t>(i), {static_cast<std::uint32_t>(j), image}});
    };
    levels.visit_near(sphere.position, sphere.radius, 1.0 + skin, levels.level_of(sphere.radius), consider);
  };
  PairBlocks blocks((count + block - 1) / block);
  parallel_for(
      blocks.size(),
      [&](std::size_t b) {
        for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i)
          find_for(i, blocks[b]);
      },
      1);
  return blocks;
}

} // namespace

void SphereNeighbours::build(const std::vector<Sphere>& spheres, std::size_t own, const ShearingBox& box, double offset,
                             double skin) {
  assert(own <= spheres.size() && skin >= 0.0);
  PairBlocks blocks = find_pairs(spheres, own, box, offset, skin);
  first_.assign(spheres.size() + 2, 0); // a counting sort: first_[i + 1] is the index of the next neighbour of i
  for (const std::vector<SpherePair>& block : blocks)
    for (const SpherePair& pair : block) {
      ++first_[pair.larger + 2];
      ++first_[pair.smaller.sphere + 2];
    }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  entries_.resize(first_.back());
  for (std::vector<SpherePair>& block : blocks) {
    for (const SpherePair& pair : block) {
      entries_[first_[pair.larger + 1]++] = pair.smaller;
      entries_[first_[pair.smaller.sphere + 1]++] = {pair.larger, -pair.smaller.image};
    }
    free_memory(block);
  }
  parallel_for(own, [&](std::size_t i) {
    std::sort(entries_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
              entries_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]),
              [&](const Neighbour& a, const Neighbour& b) {
                return std::tuple(spheres[a.sphere].particle, a.image.nx, a.image.ny) <
                       std::tuple(spheres[b.sphere].particle, b.image.nx, b.image.ny);
              });
  });
}

} // namespace keeler::initial_conditions
