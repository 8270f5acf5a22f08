// How deep particles stand inside each other: the check that every run ends with and every loader makes.
#pragma once

#include <keeler/particles/patch.hpp>

#include <cstdint>

namespace keeler {

/// The pair that overlaps most.
struct Overlap {
  double depth = 0.0; ///< (r_i + r_j − distance) / (r_i + r_j); 0 when nothing overlaps
  std::uint64_t id_i = 0, id_j = 0;
};

/// Over all pairs and images of a patch.
Overlap largest_overlap(const Patch& patch);

} // namespace keeler
