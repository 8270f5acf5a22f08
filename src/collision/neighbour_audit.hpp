// An audit of the broad phase: in each step, for a sample of the particles, the plain search tries all other particles
// in all images, and each partner that it finds must be offered by the lists or the grid: at the begin of the step, and
// at its end for some of the particles that were hit. It changes no result.
#pragma once

#include <keeler/hill/shearing_box.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace keeler::collision {

/// A pair that may touch, by straight lines in double precision, but was not offered.
struct MissedNeighbour {
  std::uint64_t id = 0, other_id = 0; ///< `id` is of the sample
  Image image;                        ///< of the other
  double distance = 0.0;              ///< of the centres at the epoch, over the radius sum
  bool after_hit = false;             ///< missed at the end of the step; otherwise at its begin
};

struct NeighbourAudit {
  std::size_t particles = 16;            ///< size of the sample, at the begin and at the end of a step
  std::uint64_t steps = 0;               ///< audited so far; the number seeds the sample
  std::uint64_t pairs = 0;               ///< found by the plain search so far
  std::optional<MissedNeighbour> missed; ///< the first one
};

} // namespace keeler::collision
