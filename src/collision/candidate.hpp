// Pairs that the broad phase offers and the finder decides about.
#pragma once

#include <keeler/hill/shearing_box.hpp>

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

namespace keeler::collision {

/// A pair that may touch in the step: the lower id first, and the image of the particle with the higher.
struct Candidate {
  std::uint32_t low, high;
  Image image;
};

/// Blocks of candidates, each filled by one thread.
using CandidateBlocks = std::vector<std::vector<Candidate>>;

/// Sorts candidates by ids and image, an order that no list and no number of threads changes.
inline void sort_by_ids(std::vector<Candidate>& candidates, const std::vector<std::uint64_t>& ids) {
  const auto key = [&](const Candidate& c) { return std::tuple(ids[c.low], ids[c.high], c.image.nx, c.image.ny); };
  std::sort(candidates.begin(), candidates.end(),
            [&](const Candidate& a, const Candidate& b) { return key(a) < key(b); });
}

} // namespace keeler::collision
